#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include <barchan/core/base/error.hpp>
#include <barchan/core/generators/close_pairs.hpp>
#include <barchan/core/generators/packing.hpp>

namespace barchan {
namespace {

Model model_of(int dimension, const Vec3& size) {
  Model model;
  model.dimension = dimension;
  model.domain.hi = size;
  model.gravity[dimension - 1] = -9.81;
  return model;
}

PackingSource source_of(const Vec3& size, double min, double max) {
  PackingSource source;
  source.region.hi = size;
  source.sizes.classes = {{min, max, 1.0}};
  return source;
}

double fraction_of(const std::vector<Grain>& grains, double volume, int dimension) {
  double sum = 0.0;
  for (const Grain& grain : grains) sum += solid_volume(grain.radius, dimension);
  return sum / volume;
}

/// Overlaps are small, nothing leaves the region, nothing reaches into a hole.
void expect_sound(const std::vector<Grain>& grains, const Model& model,
                  const PackingSource& source) {
  const PackSpace space{
      {model.dimension, source.region.lo, source.region.hi, model.domain.periodic}, source.holes};
  const std::vector<double> ratios = overlap_ratios(space, grains);
  EXPECT_LE(*std::max_element(ratios.begin(), ratios.end()), kPackedOverlap * 1.001);
  for (const Grain& grain : grains) {
    ASSERT_LE(space.intrusion(grain),
              1e-9 * grain.radius + 2e-3 * grain.radius * (source.holes.empty() ? 0 : 1));
    for (int axis = 0; axis < model.dimension; ++axis) {
      ASSERT_GE(grain.position[axis], source.region.lo[axis]);
      ASSERT_LE(grain.position[axis], source.region.hi[axis]);
    }
  }
}

bool are_same(const std::vector<Grain>& a, const std::vector<Grain>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Grain& x, const Grain& y) {
    return x.position == y.position && x.radius == y.radius;
  });
}

TEST(ClosePairs, FindsEveryPairThatAllPairsFinds) {
  for (const int dimension : {2, 3}) {
    for (const bool periodic : {false, true}) {
      CounterRandom random(5, 0);
      const PairSpace space{dimension, Vec3(-1, 0, 2), Vec3(3, 2, 5), {periodic, false, periodic}};
      std::vector<Grain> grains;
      for (int i = 0; i < 400; ++i) {
        Grain grain{space.lo, random.uniform() < 0.05 ? 0.3 : random.uniform(0.005, 0.05)};
        for (int axis = 0; axis < dimension; ++axis) {
          grain.position[axis] = random.uniform(space.lo[axis], space.hi[axis]);
        }
        grains.push_back(grain);
      }
      constexpr double kGap = 0.02;
      std::vector<std::pair<std::uint32_t, std::uint32_t>> expected;
      for (std::uint32_t i = 0; i < grains.size(); ++i) {
        for (std::uint32_t j = i + 1; j < grains.size(); ++j) {
          const double distance = space.difference(grains[i].position, grains[j].position).norm();
          if (distance <= grains[i].radius + grains[j].radius + kGap) expected.push_back({i, j});
        }
      }

      std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
      for_each_close_pair(space, grains, kGap, [&](std::uint32_t i, std::uint32_t j) {
        found.push_back({std::min(i, j), std::max(i, j)});
        return true;
      });

      std::sort(found.begin(), found.end());
      EXPECT_EQ(found, expected);
    }
  }
}

TEST(Packing, GivesExactlyTheCountAskedForFromTheBottom) {
  const Model model = model_of(2, {4, 6, 0});
  PackingSource source = source_of({4, 6, 0}, 0.04, 0.06);
  source.count = 1000;

  const std::vector<Grain> grains = make_packing(model, source, {});

  ASSERT_EQ(grains.size(), 1000u);
  expect_sound(grains, model, source);
  double top = 0.0;
  for (const Grain& grain : grains) top = std::max(top, grain.position.y());
  EXPECT_NEAR(top, 1000 * solid_volume(0.0503, 2) / 0.83 / 4, 0.15);
}

TEST(Packing, FillsTowardsGravityAlongAnyAxis) {
  Model model = model_of(2, {4, 4, 0});
  model.gravity = Vec3(5, -1, 0);
  PackingSource source = source_of({4, 4, 0}, 0.04, 0.06);
  source.count = 500;

  const std::vector<Grain> grains = make_packing(model, source, {});

  ASSERT_EQ(grains.size(), 500u);
  for (const Grain& grain : grains) EXPECT_GT(grain.position.x(), 2.5);
}

TEST(Packing, IsAsDenseAsRandomPackingsGet) {
  Model model = model_of(2, {5, 5, 0});
  model.domain.periodic = {true, true, false};
  PackingSource disks = source_of({5, 5, 0}, 0.04, 0.06);
  disks.solid_fraction = 0.83;
  const std::vector<Grain> in_plane = make_packing(model, disks, {});
  expect_sound(in_plane, model, disks);
  EXPECT_NEAR(fraction_of(in_plane, 25, 2), 0.83, 0.83 * 0.005);

  model = model_of(3, {12, 12, 12});
  model.domain.periodic = {true, true, true};
  PackingSource spheres = source_of({12, 12, 12}, 0.45, 0.55);
  spheres.solid_fraction = 0.62;
  const std::vector<Grain> in_space = make_packing(model, spheres, {});
  expect_sound(in_space, model, spheres);
  EXPECT_NEAR(fraction_of(in_space, 12 * 12 * 12, 3), 0.62, 0.62 * 0.005);
}

TEST(Packing, MeetsLooseFractionsAndKeepsHolesFree) {
  const Model model = model_of(2, {5, 5, 0});
  PackingSource source = source_of({5, 5, 0}, 0.04, 0.06);
  source.solid_fraction = 0.6;
  source.holes = {{Vec3(2, 2, 0), 0.8}};

  const std::vector<Grain> grains = make_packing(model, source, {});

  expect_sound(grains, model, source);
  EXPECT_NEAR(fraction_of(grains, 25 - solid_volume(0.8, 2), 2), 0.6, 0.003);
}

/// Half of a hole that reaches out, and a quarter of another whose centre is a corner; two holes
/// that are one and the same.
TEST(Packing, CountsOfItsHolesWhatTheyTakeFromTheRegion) {
  const Model model = model_of(2, {5, 5, 0});
  PackingSource source = source_of({5, 5, 0}, 0.04, 0.06);
  source.solid_fraction = 0.6;
  source.holes = {
      {Vec3(0, 2, 0), 1.2}, {Vec3(5, 5, 0), 1.5}, {Vec3(3, 2, 0), 0.8}, {Vec3(3, 2, 0), 0.8}};

  const std::vector<Grain> grains = make_packing(model, source, {});

  expect_sound(grains, model, source);
  const double taken = solid_volume(1.2, 2) / 2 + solid_volume(1.5, 2) / 4 + solid_volume(0.8, 2);
  EXPECT_NEAR(fraction_of(grains, 25 - taken, 2), 0.6, 0.003);
}

TEST(Packing, OfSpheresCountsHalfAHoleAsHalf) {
  const Model model = model_of(3, {6, 6, 6});
  PackingSource source = source_of({6, 6, 6}, 0.18, 0.22);
  source.solid_fraction = 0.5;
  source.holes = {{Vec3(3, 3, 0), 2.0}, {Vec3(3, 3, 0.5), 1.0}};

  const std::vector<Grain> grains = make_packing(model, source, {});

  expect_sound(grains, model, source);
  EXPECT_NEAR(fraction_of(grains, 216 - solid_volume(2.0, 3) / 2, 3), 0.5, 0.0025);
}

/// Also where a counted packing fills a part of the region only, which does not wrap.
TEST(Packing, KeepsTheImagesOfHolesFree) {
  Model model = model_of(2, {5, 5, 0});
  model.domain.periodic = {true, true, false};
  PackingSource source = source_of({5, 5, 0}, 0.04, 0.06);
  source.count = 1200;
  source.holes = {{Vec3(2, 4.8, 0), 1.0}};
  const PairSpace around{2, model.domain.lo, model.domain.hi, model.domain.periodic};
  const auto expect_free = [&](const std::vector<Grain>& grains) {
    for (const Grain& grain : grains) {
      const double distance = around.difference(grain.position, source.holes[0].center).norm();
      ASSERT_GT(distance, (1 - 2e-3) * grain.radius + 1.0) << grain.position.transpose();
    }
  };

  const std::vector<Grain> counted = make_packing(model, source, {});
  EXPECT_EQ(counted.size(), 1200u);
  expect_free(counted);

  source.count.reset();
  source.solid_fraction = 0.6;
  source.region.hi = Vec3(5, 2.5, 0);
  const std::vector<Grain> lower = make_packing(model, source, {});
  expect_free(lower);
  const double cap = std::acos(0.2) - 0.2 * std::sqrt(1 - 0.2 * 0.2);
  EXPECT_NEAR(fraction_of(lower, 12.5 - cap, 2), 0.6, 0.003);
}

TEST(Packing, RefusesHolesThatLeaveNoRoom) {
  const Model model = model_of(2, {1, 1, 0});
  PackingSource source = source_of({1, 1, 0}, 0.04, 0.06);
  source.holes = {{Vec3(0, 0, 0), 2}};
  for (const bool counts : {false, true}) {
    source.count = counts ? std::optional<std::int64_t>(10) : std::nullopt;
    source.solid_fraction = counts ? std::nullopt : std::optional(0.5);
    EXPECT_THROW((void)make_packing(model, source, {}), InputError);
  }
}

TEST(Packing, HasNoGrossGaps) {
  const Model model = model_of(2, {5, 5, 0});
  PackingSource source = source_of({5, 5, 0}, 0.04, 0.06);
  source.solid_fraction = 0.8;

  const std::vector<Grain> grains = make_packing(model, source, {});

  for (double x = 0.0; x <= 5.0; x += 0.05) {
    for (double y = 0.0; y <= 5.0; y += 0.05) {
      double nearest = 1.0;
      for (const Grain& grain : grains) {
        nearest = std::min(nearest, (grain.position - Vec3(x, y, 0)).norm() - grain.radius);
      }
      ASSERT_LT(nearest, 0.15) << x << " " << y;
    }
  }
}

TEST(Packing, PacksManyDisksFromATileInSeconds) {
  Model model = model_of(2, {100, 100, 0});
  PackingSource source = source_of({100, 100, 0}, 0.04, 0.06);
  source.count = 1000000;
  source.holes = {{Vec3(50, 40, 0), 10}};

  const auto begin = std::chrono::steady_clock::now();
  const std::vector<Grain> grains = make_packing(model, source, {});
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  ASSERT_EQ(grains.size(), 1000000u);
  expect_sound(grains, model, source);
  EXPECT_LT(seconds, 60.0);  // 2 s on an idle core; sanitizers take longer
}

TEST(Packing, MeetsAFractionFromATileToo) {
  Model model = model_of(3, {25, 25, 60});
  model.domain.periodic = {true, true, false};
  PackingSource source = source_of({25, 25, 60}, 0.45, 0.55);
  source.solid_fraction = 0.6;

  const std::vector<Grain> grains = make_packing(model, source, {});

  expect_sound(grains, model, source);
  EXPECT_NEAR(fraction_of(grains, 25 * 25 * 60, 3), 0.6, 0.003);
}

TEST(Packing, IsTheSameAgainAndAnotherForAnotherSeed) {
  const Model model = model_of(2, {3, 3, 0});
  PackingSource source = source_of({3, 3, 0}, 0.04, 0.06);
  source.count = 600;

  const std::vector<Grain> first = make_packing(model, source, {});
  const std::vector<Grain> second = make_packing(model, source, {});
  source.seed = 2;
  const std::vector<Grain> other = make_packing(model, source, {});

  EXPECT_TRUE(are_same(first, second));
  EXPECT_FALSE(are_same(first, other));
}

TEST(Packing, SaysWhatWouldFitWhenItCannot) {
  const Model model = model_of(2, {1, 1, 0});
  PackingSource source = source_of({1, 1, 0}, 0.04, 0.06);
  const SourcePlace place{"deck.toml", 12, 3};
  const auto message = [&] {
    try {
      (void)make_packing(model, source, place);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };

  source.count = 300;
  EXPECT_NE(message().find("deck.toml:12:3"), std::string::npos) << message();
  EXPECT_NE(message().find(" fit;"), std::string::npos) << message();
  source.count.reset();
  source.solid_fraction = 0.95;
  EXPECT_NE(message().find("random packing reaches 0.7"), std::string::npos) << message();
  source.region.hi = Vec3(1, 0.1, 0);
  EXPECT_NE(message().find("0.1 m wide along y"), std::string::npos) << message();
  source.region.hi = Vec3(1e9, 1e9, 0);
  EXPECT_NE(message().find("at most 1e9"), std::string::npos) << message();
}

TEST(Packing, CopesWithVeryDifferentSizes) {
  const Model model = model_of(2, {2, 2, 0});
  PackingSource source = source_of({2, 2, 0}, 0.01, 0.02);
  source.sizes.classes.push_back({0.2, 0.2, 0.005});
  source.solid_fraction = 0.8;

  const std::vector<Grain> grains = make_packing(model, source, {});

  expect_sound(grains, model, source);
  EXPECT_NEAR(fraction_of(grains, 4, 2), 0.8, 0.8 * 0.005 + 0.5 * 0.002);
}

}  // namespace
}  // namespace barchan
