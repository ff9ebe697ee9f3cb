// Sizes of particles: how they are drawn, and how much space they are expected to need.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/generators/draw_radius.hpp>
#include <barchan/core/generators/packing.hpp>

namespace barchan {
namespace {

TEST(Sizes, ClassesComeByTheirWeights) {
  const SizeDistribution sizes{
      {{1.0, 1.0, 1.0}, {2.0, 2.0, 2.0}, {3.0, 3.0, 0.5}, {4.0, 4.0, 1.5}}};
  constexpr int kDraws = 20000;
  CounterRandom random(3, 0);
  std::array<int, 5> count{};

  for (int n = 0; n < kDraws; ++n) ++count[static_cast<std::size_t>(draw_radius(sizes, random))];

  for (std::size_t c = 0; c < 4; ++c)
    EXPECT_NEAR(count[c + 1], kDraws * sizes.classes[c].weight / 5.0, 0.015 * kDraws) << c;
}

TEST(Sizes, OfARangeAreUniform) {
  const SizeDistribution sizes{{{1.0, 3.0, 1.0}}};
  constexpr int kDraws = 20000;
  CounterRandom random(4, 0);
  double sum = 0.0, squares = 0.0;

  for (int n = 0; n < kDraws; ++n) {
    const double r = draw_radius(sizes, random);
    sum += r;
    squares += r * r;
  }

  EXPECT_NEAR(sum / kDraws, 2.0, 0.02);
  EXPECT_NEAR(squares / kDraws, 13.0 / 3.0, 0.08);
}

/// What a packing says that would have too many particles. A fraction of one half, a box of this
/// width.
std::string refusal(int dimension, double width, const SizeDistribution& sizes) {
  Model model;
  model.dimension = dimension;
  PackingSource source;
  source.region.hi = dimension == 2 ? Vec3(width, width, 0.0) : Vec3::Constant(width);
  model.domain.hi = source.region.hi;
  source.sizes = sizes;
  source.solid_fraction = 0.5;
  try {
    (void)make_packing(model, source, {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Sizes, MeanVolumeIsThatOfTheRadiiDrawn) {
  const SizeDistribution range{{{1e-3, 3e-3, 1.0}}};  // means of r² and r³: 13/3 and 10
  const SizeDistribution both{{{1e-3, 3e-3, 3.0}, {2e-3, 2e-3, 1.0}}};
  const double half_disk = 0.5 / (std::numbers::pi * 1e-6),
               half_ball = 0.5 / (4.0 / 3.0 * std::numbers::pi * 1e-9);
  const auto told = [](double count) { return fmt::format("would have {:.3g} particles", count); };

  EXPECT_NE(refusal(2, 300.0, range).find(told(9e4 * half_disk / (13.0 / 3.0))), std::string::npos)
      << refusal(2, 300.0, range);
  EXPECT_NE(refusal(3, 10.0, range).find(told(1e3 * half_ball / 10.0)), std::string::npos)
      << refusal(3, 10.0, range);
  EXPECT_NE(refusal(3, 10.0, both).find(told(1e3 * half_ball / (0.75 * 10.0 + 0.25 * 8.0))),
            std::string::npos)
      << refusal(3, 10.0, both);
}

}  // namespace
}  // namespace barchan
