#include <barchan/tasks/forecast.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

Model model_of(double lo, double hi) {
  Model model;
  model.domain.lo = Vec3(lo, 0.0, 0.0);
  model.domain.hi = Vec3(hi, 10.0, 0.0);
  model.time.step = 1e-4;
  model.materials.push_back({"a", 1000.0});
  ContactConstants law;
  law.kn = 1e5;
  model.contacts = {1, {law}, true};
  model.stages.emplace_back();
  return model;
}

ParticleData disk(std::int64_t id, const Vec3& position, double radius, const Vec3& velocity) {
  ParticleData p;
  p.id = id;
  p.radius = radius;
  p.density = 1000.0;
  p.position = position;
  p.velocity = velocity;
  return p;
}

std::string only_warning(const std::vector<std::string>& warnings) {
  EXPECT_EQ(warnings.size(), 1u);
  return warnings.empty() ? "" : warnings.front();
}

TEST(SpeedWarnings, CompareTheFastestOfTheStartWithTheSmallestRadius) {
  const Model model = model_of(0.0, 10.0);
  ParticleSet set{{disk(1, {1, 1, 0}, 0.2, {60, 0, 0}), disk(2, {2, 1, 0}, 0.005, {0, 0, 0})}, {}};

  const std::string warning = only_warning(speed_warnings(model, set));
  set.particles[0].velocity[0] = 49.0;

  EXPECT_NE(warning.find("particle 1 starts at 60 m/s, 0.006 m a step"), std::string::npos);
  EXPECT_NE(warning.find("of particle 2"), std::string::npos) << warning;
  EXPECT_TRUE(speed_warnings(model, set).empty());
}

/// With a narrow skin a run ends sooner.
TEST(SpeedWarnings, CompareWithTheSkinOfTheDeckToo) {
  Model model = model_of(0.0, 10.0);
  const ParticleSet set{{disk(1, {1, 1, 0}, 0.005, {30, 0, 0})}, {}};  // 0.003 m a step
  EXPECT_TRUE(speed_warnings(model, set).empty());

  model.search.skin = 0.001;

  EXPECT_NE(only_warning(speed_warnings(model, set)).find("the run ends where it is so fast"),
            std::string::npos);
}

TEST(SpeedWarnings, CountTheFallToTheEndOfTheDomain) {
  Model model = model_of(0.0, 10.0);
  model.gravity = Vec3(0.0, -9.81, 0.0);
  const ParticleSet set{{disk(7, {1, 9, 0}, 0.001, {0, 0, 0})}, {}};

  EXPECT_NE(only_warning(speed_warnings(model, set)).find("particle 7, if it falls"),
            std::string::npos);
  model.domain.periodic[1] = true;  // nobody knows how far
  EXPECT_TRUE(speed_warnings(model, set).empty());
}

TEST(SpeedWarnings, CountPlatesAndNotPlanes) {
  Model model = model_of(0.0, 10.0);
  const ParticleSet set{{disk(1, {1, 1, 0}, 0.005, {0, 0, 0})}, {}};
  WallSpec wall;
  wall.name = "piston";
  wall.velocity = Vec3(0.0, -60.0, 0.0);
  model.walls.push_back(wall);
  EXPECT_TRUE(speed_warnings(model, set).empty());

  model.walls[0].kind = WallKind::Plate;

  EXPECT_NE(only_warning(speed_warnings(model, set)).find("wall 'piston' moves at 60 m/s"),
            std::string::npos);
}

/// What a run of a box far out makes of a deck that is sound at the origin.
std::string verdict(double away, double speed) {
  const Model model = model_of(away, away + 10.0);
  const ParticleSet set{{disk(1, {away + 1, 1, 0}, 0.05, {speed, 0, 0})}, {}};
  try {
    check_precision(model, set);
  } catch (const InputError& e) {
    return std::string("refused: ") + e.what();
  }
  const auto warnings = precision_warnings(model, set);
  return warnings.empty() ? "fine" : "warned: " + warnings.front();
}

TEST(PrecisionOfADeck, IsRefusedWhereRoundingTakesTheMotionAway) {
  EXPECT_EQ(verdict(0.0, 4e-6), "fine");
  const std::string refused = verdict(5e6, 4e-6);  // 4e-10 m a step
  EXPECT_EQ(refused.find("refused: "), 0u) << refused;
  EXPECT_NE(refused.find("9.3e-10 m apart"), std::string::npos) << refused;
  EXPECT_NE(refused.find("4e-10 m a step"), std::string::npos) << refused;
  EXPECT_NE(refused.find("subtract (5000000, 0)"), std::string::npos) << refused;
}

TEST(PrecisionOfADeck, IsNoQuestionOfTheOriginWhereTheDomainIsThere) {
  const std::string refused = verdict(0.0, 4e-15);
  EXPECT_EQ(refused.find("refused: "), 0u) << refused;
  EXPECT_NE(refused.find("a smaller domain or a larger time.step"), std::string::npos) << refused;
}

TEST(PrecisionOfADeck, IsAWarningWhereFewDigitsRemain) {
  EXPECT_EQ(verdict(5e6, 4e-3).find("warned: "), 0u) << verdict(5e6, 4e-3);
  EXPECT_EQ(verdict(5e6, 1.0), "fine");
}

TEST(PrecisionOfADeck, CountsOverlapsByWeightAndRadii) {
  Model model = model_of(5e6, 5e6 + 10.0);
  model.gravity = Vec3(0.0, -9.81, 0.0);
  model.contacts.constants[0].kn = 1e11;  // weight over stiffness: 8e-10 m
  const ParticleSet set{{disk(1, {5e6 + 1, 1, 0}, 0.05, {0, 0, 0})}, {}};
  EXPECT_THROW(check_precision(model, set), InputError);

  model = model_of(5e12, 5e12 + 10.0);

  EXPECT_THROW(check_precision(model, set), InputError);  // numbers are a millimetre apart
}

/// A run as large or small as one likes has the same digits.
TEST(PrecisionOfADeck, KnowsNoAbsoluteLength) {
  for (const int k : {-60, -30, 30, 60}) {
    Model model = model_of(0.0, 10.0);
    ParticleSet set{{disk(1, {1, 1, 0}, 0.05, {1e-10, 0, 0})}, {}};
    const Precision plain = precision_of(model, set);
    const double scale = std::ldexp(1.0, k);
    model.domain.hi *= scale;
    set.particles[0].radius *= scale;
    set.particles[0].velocity *= scale;
    set.particles[0].density /= scale * scale;

    const Precision scaled = precision_of(model, set);

    EXPECT_EQ(scaled.spacing, scale * plain.spacing);
    EXPECT_EQ(scaled.travel, scale * plain.travel);
    EXPECT_EQ(scaled.most_overlap, scale * plain.most_overlap);
  }
}

TEST(DefaultSkin, IsAShareOfTheMeanRadius) {
  const Model model = model_of(0.0, 10.0);
  const ParticleSet two{{disk(1, {1, 1, 0}, 0.04, {9, 0, 0}), disk(2, {2, 1, 0}, 0.06, {0, 0, 0})},
                        {}};
  const ParticleSet one{{disk(1, {1, 1, 0}, 1.0, {0, 0, 0})}, {}};
  EXPECT_NEAR(default_skin(model, two) / 0.05, default_skin(model, one), 1e-12);
}

/// What may pass another one in a step is in the lists.
TEST(DefaultSkin, TakesSpeedsOfTheDeckIntoAccount) {
  Model model = model_of(0.0, 10.0);
  const auto set = [](double speed) {
    return ParticleSet{{disk(1, {1, 9, 0}, 0.01, {speed, 0, 0})}, {}};
  };
  const double usual = default_skin(model, set(0.0));
  EXPECT_EQ(default_skin(model, set(40.0)), usual);
  EXPECT_NEAR(default_skin(model, set(80.0)), 1.05 * 2.0 * 80.0 * 1e-4, 1e-12);
  EXPECT_NEAR(default_skin(model, set(1e4)), 0.02, 1e-12) << "the mean diameter";

  model.gravity = Vec3(0.0, -350.0, 0.0);  // 79 m/s at the lower end
  EXPECT_GT(default_skin(model, set(0.0)), 0.016);
  model.gravity = Vec3::Zero();
  model.walls.emplace_back().velocity = Vec3(0.0, 80.0, 0.0);
  EXPECT_GT(default_skin(model, set(0.0)), 0.016);
}

}  // namespace
}  // namespace barchan
