#include <barchan/core/kernels/kernel_set.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <random>
#include <utility>

#include <unit/core/kernel_sample.hpp>

namespace barchan::test {
namespace {

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

}  // namespace
}  // namespace barchan::test
