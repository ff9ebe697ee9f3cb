#include <barchan/core/kernels/kernel_set.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <unit/core/kernel_sample.hpp>

namespace barchan::test {
namespace {

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
    ASSERT_TRUE(same_values(after[w].list.history, after[0].list.history)) << what;
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
  empty.list.reset_history(LinearSpring::kHistory<2>.length);
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
    const double mu = laws.row(sample.list.code[k])[LinearSpring::Mu];
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
    for (int q = 0; q < there.list.history_length; ++q) {
      const auto at = static_cast<std::int64_t>(k);
      ASSERT_EQ(there.list.history_of(at)[q * kBatch],
                LinearSpring::kHistory<Dim>.sign(q, true) * back.list.history_of(at)[q * kBatch]);
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

TEST(Kernels, AdvanceRowsToTheSameBitsAtAnyWidth) {
  expect_same_rows<2>();
  expect_same_rows<3>();
}

}  // namespace
}  // namespace barchan::test
