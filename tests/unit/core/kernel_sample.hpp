#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <barchan/core/kernels/force_grain.hpp>
#include <barchan/core/kernels/kernel_set.hpp>
#include <barchan/core/search/pair_list.hpp>

#include "lane_fixture.hpp"

// Pairs and rows for tests of kernels.

namespace barchan::test {

inline constexpr ForceGrain kGrain{0x1p-30};

/// Records of particles, the last two of them waste, and a list of pairs among them.
template <int Dim>
struct Sample {
  using L = Layout<Dim>;
  int num_rows;
  AlignedVector<double> motion, spin, force;
  PairList list;

  Sample(int particles, int pairs, int num_laws, unsigned seed,
         int history_length = LinearSpring::kHistory<Dim>.length)
      : num_rows(particles + 2) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    const auto n = static_cast<std::size_t>(num_rows);
    motion.resize(n * L::kMotion);
    spin.assign(n * 4, 0.0);
    start_forces();
    for (std::size_t i = 0; i < n; ++i) {
      double* m = motion.data() + i * L::kMotion;
      for (int c = 0; c < Dim; ++c) m[c] = any(random);
      m[L::kRadius] = 0.2 + 0.2 * std::fabs(any(random));
      for (int c = 4; c < 7; ++c) m[c] = 3.0 * any(random);
      m[L::kInverseMass] = i % 9 == 0 ? 0.0 : 0.5 + std::fabs(any(random));
      for (int c = 0; c < 3; ++c) spin[4 * i + static_cast<std::size_t>(c)] = 2.0 * any(random);
      inverse_radius(i) = 1.0 / m[L::kRadius];
    }
    for (std::size_t w = n - 2; w < n; ++w) {
      std::fill_n(motion.data() + w * L::kMotion, 8, 0.0);
      motion[w * L::kMotion] = -1e9 * static_cast<double>(1 + w - (n - 2));
      motion[w * L::kMotion + L::kInverseMass] = 1.0;
      inverse_radius(w) = 1.0;
    }
    while (list.size() < pairs) {
      const auto a = static_cast<std::int32_t>(random() % static_cast<unsigned>(particles));
      const auto b = static_cast<std::int32_t>(random() % static_cast<unsigned>(particles));
      if (a == b || (a % 9 == 0 && b % 9 == 0)) continue;  // two fixed particles are never listed
      list.push(std::min(a, b), std::max(a, b),
                static_cast<std::uint8_t>(random() % static_cast<unsigned>(num_laws)));
    }
    list.pad(particles);
    list.reset_history(history_length);
  }

  double& inverse_radius(std::size_t row) {
    return (Dim == 2 ? motion
                     : spin)[row * std::size_t{Dim == 2 ? L::kMotion : 4} + L::kInverseRadius];
  }
  void start_forces() {
    force.resize(static_cast<std::size_t>(num_rows) * L::kForce);
    for (std::size_t c = 0; c < force.size(); ++c) force[c] = c % 4 < 3 ? kGrain.rounder() : 0.0;
  }
  /// Without what it starts from.
  [[nodiscard]] double component(std::size_t c) const {
    return force[c] - (c % 4 < 3 ? kGrain.rounder() : 0.0);
  }

  /// Pair k touches just so, or not by one unit in the last place.
  void barely(std::int64_t k, bool touches) {
    const auto i = static_cast<std::size_t>(list.i[static_cast<std::size_t>(k)]),
               j = static_cast<std::size_t>(list.j[static_cast<std::size_t>(k)]);
    double *a = motion.data() + i * L::kMotion, *b = motion.data() + j * L::kMotion;
    std::fill_n(a, Dim, 0.0);
    std::fill_n(b, Dim, 0.0);
    a[L::kRadius] = b[L::kRadius] = 0.25;
    b[Dim - 1] = touches ? std::nextafter(0.5, 0.0) : 0.5;
  }

  PairJob job(const LawTable& laws, const PeriodicBox& box) {
    PairJob j;
    j.motion = motion.data();
    j.spin = spin.data();
    j.force = force.data();
    j.i = list.i.data();
    j.j = list.j.data();
    j.code = list.code.data();
    j.history = list.history.data();
    j.end = list.size();
    j.dt = 2e-2;
    j.box = box;
    j.laws = laws.view();
    return j;
  }
};

/// The force record of every pair in its last of `steps` steps: pairs one by one, on a clean row.
template <int Dim>
std::vector<std::vector<double>> forces_of_pairs(Sample<Dim>& s, const LawTable& laws,
                                                 const PeriodicBox& box, int steps) {
  using L = Layout<Dim>;
  const KernelSet kernels = make_kernels(Dim, VectorWidth::Scalar, laws, true, box);
  std::vector<std::vector<double>> forces(s.list.i.size());
  for (int n = 0; n < steps; ++n) {
    for (std::size_t k = 0; k < forces.size(); ++k) {
      forces[k].clear();
      PairJob job = s.job(laws, box);
      job.begin = static_cast<std::int64_t>(k);
      job.end = job.begin + 1;
      s.start_forces();
      kernels.pairs(job);
      const std::size_t f = static_cast<std::size_t>(s.list.i[k]) * L::kForce;
      for (std::size_t c = 0; c < L::kForce; ++c) forces[k].push_back(s.component(f + c));
    }
  }
  return forces;
}

inline bool same_bits(const AlignedVector<double>& a, const AlignedVector<double>& b) {
  return std::ranges::equal(a, b, [](double p, double q) {
    return std::bit_cast<std::uint64_t>(p) == std::bit_cast<std::uint64_t>(q);
  });
}

/// A zero of either sign is the same: sums that start from +0 never show it.
inline bool same_values(const AlignedVector<double>& a, const AlignedVector<double>& b) {
  return std::ranges::equal(a, b);
}

enum class Dashpots { Constant, Rate, Critical, Both };

inline LawTable laws_of(int num_materials, Dashpots dashpots, bool no_tension) {
  ContactTable table = table_of(num_materials, no_tension);
  for (ContactConstants& c : table.constants) {
    if (dashpots == Dashpots::Rate || dashpots == Dashpots::Both) c.cn.rate = 10.0, c.ct.rate = 3.0;
    if (dashpots == Dashpots::Critical || dashpots == Dashpots::Both)
      c.cn.critical = 0.3 * std::sqrt(c.kn), c.ct.critical = 2.0;
  }
  return LawTable(table);
}

template <int Dim>
PeriodicBox box_of(bool periodic) {
  PeriodicBox box;
  for (int a = 0; periodic && a < Dim; a += 2) box.length[a] = 1.6, box.inverse[a] = 1.0 / 1.6;
  return box;
}

/// The force records of both ends after three steps of one pair.
template <int Dim>
std::array<std::vector<double>, 2> forces_of_ends(Sample<Dim>& s, const LawTable& laws,
                                                  std::size_t pair) {
  using L = Layout<Dim>;
  const KernelSet kernels = make_kernels(Dim, VectorWidth::Scalar, laws, true, {});
  PairJob job = s.job(laws, {});
  job.begin = static_cast<std::int64_t>(pair);
  job.end = job.begin + 1;
  for (int n = 0; n < 3; ++n) {
    s.start_forces();
    kernels.pairs(job);
  }
  std::array<std::vector<double>, 2> forces;
  for (std::size_t c = 0; c < L::kForce; ++c) {
    forces[0].push_back(s.component(static_cast<std::size_t>(s.list.i[pair]) * L::kForce + c));
    forces[1].push_back(s.component(static_cast<std::size_t>(s.list.j[pair]) * L::kForce + c));
  }
  return forces;
}

}  // namespace barchan::test
