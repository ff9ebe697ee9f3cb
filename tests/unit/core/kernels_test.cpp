#include <barchan/core/kernels/kernel_set.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <barchan/core/force_grain.hpp>
#include <barchan/core/pair_list.hpp>

#include "lane_fixture.hpp"

namespace barchan::test {
namespace {

constexpr ForceGrain kGrain{0x1p-30};

/// Records of particles, the last two of them waste, and a list of pairs among them.
template <int Dim>
struct Sample {
  using L = Layout<Dim>;
  int num_rows;
  AlignedVector<double> motion, spin, force;
  PairList list;

  Sample(int particles, int pairs, int num_laws, unsigned seed) : num_rows(particles + 2) {
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
    }
    for (std::size_t w = n - 2; w < n; ++w) {
      std::fill_n(motion.data() + w * L::kMotion, 8, 0.0);
      motion[w * L::kMotion] = -1e9 * static_cast<double>(1 + w - (n - 2));
      motion[w * L::kMotion + L::kInverseMass] = 1.0;
    }
    while (list.size() < pairs) {
      const auto a = static_cast<std::int32_t>(random() % static_cast<unsigned>(particles));
      const auto b = static_cast<std::int32_t>(random() % static_cast<unsigned>(particles));
      if (a == b || (a % 9 == 0 && b % 9 == 0)) continue;  // two fixed particles are never listed
      list.push(std::min(a, b), std::max(a, b),
                static_cast<std::uint8_t>(random() % static_cast<unsigned>(num_laws)));
    }
    list.pad(particles);
    list.template reset_springs<Dim>();
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
    j.spring = list.spring.data();
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

bool same_bits(const AlignedVector<double>& a, const AlignedVector<double>& b) {
  return std::ranges::equal(a, b, [](double p, double q) {
    return std::bit_cast<std::uint64_t>(p) == std::bit_cast<std::uint64_t>(q);
  });
}

/// A zero of either sign is the same: sums that start from +0 never show it.
bool same_values(const AlignedVector<double>& a, const AlignedVector<double>& b) {
  return std::ranges::equal(a, b);
}

enum class Dashpots { Constant, Rate, Critical, Both };

LawTable laws_of(int num_materials, Dashpots dashpots, bool no_tension) {
  ContactTable table = table_of(num_materials, no_tension);
  for (ContactConstants& c : table.constants) {
    if (dashpots == Dashpots::Rate || dashpots == Dashpots::Both) c.cn.rate = 10.0, c.ct.rate = 3.0;
    if (dashpots == Dashpots::Critical || dashpots == Dashpots::Both)
      c.cn.critical = 0.3 * std::sqrt(c.kn), c.ct.critical = 2.0;
  }
  return LawTable(table);
}

struct Choice {
  int num_materials;
  Dashpots dashpots;
  bool no_tension, has_bonds, periodic;
};

std::vector<Choice> choices() {
  std::vector<Choice> all;
  for (const int materials :
       {1, 2, 3, 5}) {  // 2, 4, 7 and 16 laws: one, one register, one register, more than that
    for (const Dashpots d :
         {Dashpots::Constant, Dashpots::Rate, Dashpots::Critical, Dashpots::Both}) {
      for (int bits = 0; bits < 8; ++bits)
        all.push_back({materials, d, (bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0});
    }
  }
  return all;
}

template <int Dim>
PeriodicBox box_of(bool periodic) {
  PeriodicBox box;
  for (int a = 0; periodic && a < Dim; a += 2) box.length[a] = 1.6, box.inverse[a] = 1.0 / 1.6;
  return box;
}

/// Three steps of every kernel, so that springs build up, slide and stick.
template <int Dim>
void expect_same_at_any_width(const Choice& c, int pairs) {
  const LawTable laws = laws_of(c.num_materials, c.dashpots, c.no_tension);
  const PeriodicBox box = box_of<Dim>(c.periodic);
  const int first_law = c.has_bonds ? 0 : 1;
  Sample<Dim> sample(40, pairs, laws.size(), 11);
  for (auto& code : sample.list.code)
    code = std::max<std::uint8_t>(code, static_cast<std::uint8_t>(first_law));
  if (pairs > 4) {
    sample.barely(1, true);
    sample.barely(3, false);
  }
  std::vector<Sample<Dim>> after;
  for (const VectorWidth width : vector_widths()) {
    after.push_back(sample);
    const KernelSet kernels = make_kernels(Dim, width, laws, c.has_bonds, box);
    for (int n = 0; n < 3; ++n) kernels.pairs(after.back().job(laws, box));
  }
  for (std::size_t w = 1; w < after.size(); ++w) {
    const auto what =
        fmt::format("{}, {}D, {} pairs, {} materials, dashpots {}, clamp {}, bonds {}, periodic {}",
                    name_of(vector_widths()[w]), Dim, pairs, c.num_materials,
                    static_cast<int>(c.dashpots), c.no_tension, c.has_bonds, c.periodic);
    ASSERT_TRUE(same_bits(after[w].force, after[0].force)) << what;
    ASSERT_TRUE(same_values(after[w].list.spring, after[0].list.spring)) << what;
  }
}

TEST(Kernels, GiveTheSameBitsAtAnyWidthIn2D) {
  for (const Choice& c : choices()) expect_same_at_any_width<2>(c, 200);
}

TEST(Kernels, GiveTheSameBitsAtAnyWidthIn3D) {
  for (const Choice& c : choices()) expect_same_at_any_width<3>(c, 200);
}

TEST(Kernels, PaddingOfTheLastBatchDoesNothing) {
  for (int pairs = 1; pairs <= 17; ++pairs) {
    for (const bool periodic : {false, true}) {
      expect_same_at_any_width<2>({2, Dashpots::Both, true, true, periodic}, pairs);
      expect_same_at_any_width<3>({2, Dashpots::Both, true, true, periodic}, pairs);
    }
  }
  Sample<2> empty(4, 0, 2, 1);
  empty.list.push(4, 5, 0);
  empty.list.pad(4);
  empty.list.reset_springs<2>();
  const LawTable laws = laws_of(1, Dashpots::Critical, false);
  for (const VectorWidth width : vector_widths()) {
    make_kernels(2, width, laws, true, box_of<2>(true)).pairs(empty.job(laws, box_of<2>(true)));
    for (std::size_t c = 0; c < empty.force.size(); ++c) EXPECT_EQ(empty.component(c), 0.0);
  }
}

TEST(Kernels, SampleHasPairsThatSlideStickAndDoNotTouch) {
  const LawTable laws = laws_of(2, Dashpots::Constant, true);
  Sample<2> sample(40, 200, laws.size(), 11);
  const auto forces = forces_of_pairs(sample, laws, {}, 3);
  int apart = 0, sliding = 0, sticking = 0;
  for (std::size_t k = 0; k < 200; ++k) {
    if (sample.list.code[k] == 0) continue;
    const double* f = forces[k].data();
    const double mu = laws.view().rows[LawView::kRow * sample.list.code[k] + LawView::Mu];
    const double ft = std::fabs(f[2]), total = std::hypot(f[0], f[1]),
                 fn = std::sqrt(std::max(0.0, total * total - ft * ft));
    if (total == 0.0)
      ++apart;
    else if (ft > 0.9999 * mu * fn)
      ++sliding;
    else
      ++sticking;
  }
  EXPECT_GT(apart, 10);
  EXPECT_GT(sliding, 10);
  EXPECT_GT(sticking, 10);
}

template <int Dim>
void expect_antisymmetric(const Choice& c) {
  using L = Layout<Dim>;
  const LawTable laws = laws_of(c.num_materials, c.dashpots, c.no_tension);
  const PeriodicBox box = box_of<Dim>(c.periodic);
  Sample<Dim> there(40, 120, laws.size(), 21), back = there;
  for (std::size_t k = 0; k < 120; ++k) std::swap(back.list.i[k], back.list.j[k]);

  const auto one_way = forces_of_pairs(there, laws, box, 3);
  const auto other_way = forces_of_pairs(back, laws, box, 3);

  for (std::size_t k = 0; k < 120; ++k) {
    const double *f = one_way[k].data(), *g = other_way[k].data();
    for (int q = 0; q < Dim; ++q) ASSERT_EQ(f[q], -g[q]);
    for (int q = L::kTorque; q < L::kTorque + kSpins<Dim>; ++q) ASSERT_EQ(f[q], g[q]);
    for (int q = 0; q < L::kSprings; ++q) {
      const auto at = static_cast<std::int64_t>(k);
      ASSERT_EQ(there.list.template springs<Dim>(at)[q * kBatch],
                (Dim == 3 ? -1.0 : 1.0) * back.list.template springs<Dim>(at)[q * kBatch]);
    }
  }
}

TEST(Kernels, SwappingAPairNegatesItsForceAndKeepsItsTorqueToTheBit) {
  for (const Choice& c : choices()) {
    expect_antisymmetric<2>(c);
    expect_antisymmetric<3>(c);
  }
}

template <int Dim>
void expect_masks() {
  for (const bool periodic : {false, true}) {
    const LawTable laws = laws_of(2, Dashpots::Constant, true);
    const PeriodicBox box = box_of<Dim>(periodic);
    Sample<Dim> sample(40, 200, laws.size(), 31);
    for (auto& code : sample.list.code) code = std::max<std::uint8_t>(code, 1);
    sample.barely(1, true);
    sample.barely(3, false);
    const auto forces = forces_of_pairs(sample, laws, box, 1);
    for (const VectorWidth width : vector_widths()) {
      const KernelSet kernels = make_kernels(Dim, width, laws, true, box);
      if (kernels.narrow == nullptr) continue;
      std::vector<std::uint8_t> masks(sample.list.i.size() / kBatch, 0xaa);

      kernels.narrow(sample.job(laws, box), 0.0, masks.data());

      for (std::size_t k = 0; k < 200; ++k) {
        const double* f = forces[k].data();
        const bool acts =
            std::any_of(f, f + Layout<Dim>::kForce, [](double c) { return c != 0.0; });
        const bool touches = ((masks[k / 8] >> (k % 8)) & 1U) != 0;
        if (acts) {
          EXPECT_TRUE(touches) << name_of(width) << ", pair " << k;
        }
        if (k == 1) {
          EXPECT_TRUE(touches) << name_of(width);
        }
        if (k == 3) {
          EXPECT_FALSE(touches) << name_of(width);
        }
      }
    }
  }
}

TEST(Kernels, NarrowPhaseMarksEveryPairThatActs) {
  expect_masks<2>();
  expect_masks<3>();
}

template <int Dim>
void expect_same_rows() {
  using L = Layout<Dim>;
  for (const bool damped : {false, true}) {
    std::vector<Sample<Dim>> after;
    for (const VectorWidth width : vector_widths()) {
      after.emplace_back(41, 8, 2, 41);
      Sample<Dim>& s = after.back();
      for (std::size_t c = 0; c < s.force.size(); ++c)
        s.force[c] = std::sin(static_cast<double>(c));
      for (std::size_t i = 0; i < 43; ++i) s.force[i * L::kForce + 3] = 0.0;
      const KernelSet kernels =
          make_kernels(Dim, width, laws_of(1, Dashpots::Constant, true), false, {});
      RowJob job{s.motion.data(),   s.spin.data(),     s.force.data(), 1, 40, 1e-3, 2e-3,
                 {0.1, -9.81, 0.3}, damped ? 0.3 : 0.0};
      (damped ? kernels.rows_damped : kernels.rows)(job);
    }
    for (std::size_t w = 1; w < after.size(); ++w) {
      EXPECT_TRUE(same_bits(after[w].motion, after[0].motion)) << name_of(vector_widths()[w]);
      EXPECT_TRUE(same_bits(after[w].spin, after[0].spin)) << name_of(vector_widths()[w]);
      EXPECT_TRUE(same_bits(after[w].force, after[0].force)) << name_of(vector_widths()[w]);
    }
  }
}

template <int Dim>
void expect_sums_without_order() {
  using L = Layout<Dim>;
  const LawTable laws = laws_of(3, Dashpots::Both, true);
  const PeriodicBox box = box_of<Dim>(true);
  Sample<Dim> forward(40, 400, laws.size(), 51), shuffled = forward;
  std::mt19937_64 random(3);
  for (std::size_t k = 399; k > 0; --k) {
    const std::size_t q = random() % (k + 1);
    std::swap(shuffled.list.i[k], shuffled.list.i[q]);
    std::swap(shuffled.list.j[k], shuffled.list.j[q]);
    std::swap(shuffled.list.code[k], shuffled.list.code[q]);
    if (random() % 2 == 0) std::swap(shuffled.list.i[k], shuffled.list.j[k]);
  }
  const KernelSet kernels = make_kernels(Dim, vector_widths().back(), laws, true, box);

  kernels.pairs(forward.job(laws, box));
  kernels.pairs(shuffled.job(laws, box));

  for (std::size_t c = 0; c < forward.force.size(); ++c) {
    if (c % 4 < 3)
      EXPECT_EQ(forward.force[c], shuffled.force[c]);
    else
      EXPECT_NEAR(forward.force[c], shuffled.force[c], 1e-12 * std::fabs(forward.force[c]));
  }
  for (int c = 0; c < Dim; ++c) {
    double sum = 0.0;  // exact, in any order
    for (std::size_t f = 0; f < forward.force.size(); f += L::kForce)
      sum += forward.component(f + static_cast<std::size_t>(c));
    EXPECT_EQ(sum, 0.0) << "component " << c;
  }
}

TEST(Kernels, SumTheSameInAnyOrderAndToZeroOverAll) {
  expect_sums_without_order<2>();
  expect_sums_without_order<3>();
}

template <int Dim>
void expect_bounded_multiples(std::initializer_list<std::size_t> components) {
  const LawTable laws = laws_of(2, Dashpots::Both, false);
  Sample<Dim> sample(40, 200, laws.size(), 61);
  for (const auto& f : forces_of_pairs(sample, laws, {}, 2)) {
    for (const std::size_t c : components) {
      EXPECT_EQ(std::remainder(f[c], kGrain.size), 0.0);
      EXPECT_LE(std::fabs(f[c]), f[3] + kGrain.size);
      EXPECT_FALSE(f[c] == 0.0 && std::signbit(f[c]));
    }
  }
}

TEST(Kernels, RoundToMultiplesOfTheGrainAndBoundEachComponent) {
  expect_bounded_multiples<2>({0, 1, 2});
  expect_bounded_multiples<3>({0, 1, 2, 4, 5, 6});
}

/// Pairs along x, twice each, that press and, with a slip, rub along the last axis: with as many
/// grains each time, so with ties where that is a half more than a whole number.
template <int Dim>
void expect_rounded_outwards(VectorWidth width, double grains, bool slips) {
  using L = Layout<Dim>;
  ContactTable table{1, {ContactConstants{}}, true};
  table.constants[0].kn = table.constants[0].ct.constant = 2.0 * grains * kGrain.size;
  table.constants[0].mu = 10.0;
  const LawTable laws(table);
  const KernelSet kernels = make_kernels(Dim, width, laws, false, {});
  Sample<Dim> s(9, 8, 1, 71);
  s.spin.assign(s.spin.size(), 0.0);
  for (int k = 0; k < 8; ++k) {
    double* x = s.motion.data() + 8 * k;
    std::fill_n(x, 8, 0.0);
    x[0] = k % 2 == 0 ? 0.0 : 0.5;
    x[L::kRadius] = 0.5;
    x[4 + Dim - 1] = k % 2 == 1 && slips ? 0.5 : 0.0;
    const auto pair = static_cast<std::size_t>(k);
    s.list.i[pair] = k / 2 * 2, s.list.j[pair] = s.list.i[pair] + 1;
    s.list.code[pair] = laws.code(0, 0);
  }

  kernels.pairs(s.job(laws, {}));

  const double both = 2.0 * std::ceil(grains) * kGrain.size, rub = slips ? both : 0.0;
  for (std::size_t k = 0; k < 8; ++k) {
    const double side = k % 2 == 0 ? 1.0 : -1.0;  // the two feel opposite forces and equal torques
    const std::vector<double> expected =
        Dim == 2 ? std::vector<double>{-side * both, side * rub, rub}
                 : std::vector<double>{-side * both, 0.0, side * rub, -1.0, 0.0, -rub, 0.0};
    EXPECT_EQ(s.component(k * L::kForce + 3), 2.0 * (1.0 + 10.0) * grains * kGrain.size)
        << name_of(width) << ", " << Dim << "D, sizes";
    for (std::size_t c = 0; c < expected.size(); ++c) {
      if (c == 3) continue;
      EXPECT_EQ(s.component(k * L::kForce + c), expected[c])
          << name_of(width) << ", " << Dim << "D, " << grains << " grains, component " << c;
    }
  }
}

TEST(Kernels, AddTiesAndZerosAlikeInAnyOrder) {
  for (const VectorWidth width : vector_widths()) {
    for (const double grains : {4.5, 5.5}) {  // to even would be inwards, and outwards
      for (const bool slips : {false, true}) {
        expect_rounded_outwards<2>(width, grains, slips);
        expect_rounded_outwards<3>(width, grains, slips);
      }
    }
  }
}

TEST(Kernels, TellWhatTheMostPressedRowBears) {
  for (const VectorWidth width : vector_widths()) {
    for (const int dim : {2, 3}) {
      Sample<3> s(9, 8, 2, 71);
      const auto force = static_cast<std::size_t>(dim == 2 ? 4 : 8);
      s.force[3 * force + 3] = 101.0;
      s.force[7 * force + 3] = 100.0;
      const KernelSet kernels =
          make_kernels(dim, width, laws_of(1, Dashpots::Constant, true), false, {});
      RowJob job{s.motion.data(), s.spin.data(), s.force.data(), 0, 9, 1e-3, 1e-3, {}, 0.0};
      job.rounder = kGrain.rounder();

      EXPECT_EQ(kernels.rows(job).top_force, 101.0) << name_of(width) << ", " << dim << "D";
      EXPECT_EQ(s.force[3 * force], kGrain.rounder()) << "sums start anew";
      EXPECT_EQ(s.force[3 * force + 3], 0.0);
    }
  }
}

TEST(Kernels, AdvanceRowsToTheSameBitsAtAnyWidth) {
  expect_same_rows<2>();
  expect_same_rows<3>();
}

}  // namespace
}  // namespace barchan::test
