#include <barchan/tasks/stability.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <barchan/core/base/error.hpp>
#include <barchan/core/links/bonds.hpp>

namespace barchan {
namespace {

Model model_of(int num_materials) {
  Model model;
  model.domain.hi = Vec3(10, 10, 0);
  model.stages.emplace_back();
  model.contacts.num_materials = num_materials;
  for (int a = 0; a < num_materials; ++a)
    model.materials.push_back({std::string(1, static_cast<char>('a' + a)), 1000.0});
  ContactConstants law;
  law.kn = 1e5;
  model.contacts.constants.assign(static_cast<std::size_t>(num_materials * num_materials), law);
  return model;
}

ParticleData disk(std::int64_t id, double x, double radius) {
  ParticleData p;
  p.id = id;
  p.radius = radius;
  p.density = 1000.0;
  p.position = Vec3(x, 1.0, 0.0);
  return p;
}

double mass(double radius) {
  return std::numbers::pi * radius * radius * 1000.0;
}

double limit(const std::vector<StepLimit>& limits, const std::string& what) {
  const auto it = std::find_if(limits.begin(), limits.end(),
                               [&](const StepLimit& l) { return l.what == what; });
  return it == limits.end() ? -1.0 : it->step;
}

/// Whether two particles on a spring stay bounded under the scheme of a run.
bool is_bounded(double m, double k, double c, double dt) {
  double x = 1e-3, v = 0.0;
  for (int step = 0; step < 20000; ++step) {
    v += dt * (-k * x - c * v) / m;
    x += dt * v;
    if (!(std::fabs(x) < 1.0)) return false;
  }
  return true;
}

TEST(StepLimits, OfAContactIsThatOfTheTwoLightest) {
  const Model model = model_of(1);
  const ParticleSet set{{disk(1, 1, 0.1), disk(2, 2, 0.05), disk(3, 3, 0.05)}, {}};

  const auto limits = step_limits(model, set);

  EXPECT_NEAR(limit(limits, "contact a–a"), 2.0 * std::sqrt(0.5 * mass(0.05) / 1e5), 1e-15);
}

TEST(StepLimits, AreWhereTheSchemeStartsToDiverge) {
  for (const double c : {0.0, 30.0, 400.0, 3000.0}) {
    Model model = model_of(1);
    model.contacts.constants[0].cn.constant = c;
    const ParticleSet set{{disk(1, 1, 0.05), disk(2, 2, 0.05)}, {}};
    const double m_eff = 0.5 * mass(0.05);

    const double step = limit(step_limits(model, set), c > 0.0 ? "damping a–a" : "contact a–a");

    EXPECT_TRUE(is_bounded(m_eff, 1e5, c, 0.999 * step)) << c;
    EXPECT_FALSE(is_bounded(m_eff, 1e5, c, 1.001 * step)) << c;
  }
}

TEST(StepLimits, OfSlidingCountThatAPushAlsoTurns) {
  for (const int dimension : {2, 3}) {
    Model model = model_of(1);
    model.dimension = dimension;
    model.domain.hi[2] = dimension == 3 ? 10.0 : 0.0;
    model.contacts.constants[0].kt = 4e4;
    const ParticleSet set{{disk(1, 1, 0.05), disk(2, 2, 0.05)}, {}};
    const double m = dimension == 2 ? mass(0.05) : mass(0.05) * 4.0 / 3.0 * 0.05;
    const double turning = dimension == 2 ? 2.0 : 2.5;  // m·r²/I

    EXPECT_NEAR(limit(step_limits(model, set), "tangential a–a"),
                2.0 * std::sqrt(0.5 * m / (1.0 + turning) / 4e4), 1e-12);
  }
}

TEST(StepLimits, TakeAFixedParticleForInfinitelyHeavy) {
  const Model model = model_of(1);
  ParticleSet set{{disk(1, 1, 0.05), disk(2, 2, 0.05)}, {}};
  set.particles[1].fixed = true;

  EXPECT_NEAR(limit(step_limits(model, set), "contact a–a"), 2.0 * std::sqrt(mass(0.05) / 1e5),
              1e-15);
}

TEST(StepLimits, SkipMaterialsThatNobodyIsMadeOf) {
  const Model model = model_of(2);
  const ParticleSet set{{disk(1, 1, 0.05), disk(2, 2, 0.05)}, {}};

  const auto limits = step_limits(model, set);

  EXPECT_GT(limit(limits, "contact a–a"), 0.0);
  EXPECT_EQ(limit(limits, "contact a–b"), -1.0);
}

TEST(StepLimits, OfAWallHaveTheWholeMass) {
  Model model = model_of(2);
  WallSpec wall;
  wall.material = 1;
  model.walls.push_back(wall);
  const ParticleSet set{{disk(1, 1, 0.05)}, {}};

  EXPECT_NEAR(limit(step_limits(model, set), "contact a–wall of b"),
              2.0 * std::sqrt(mass(0.05) / 1e5), 1e-15);
}

TEST(StepLimits, OfAChainOfBondsAreThoseOfALongChain) {
  Model model = model_of(1);
  BondLaw law;
  law.name = "glue";
  law.young_modulus = 1e6;
  model.bond_laws.push_back(law);
  ParticleSet set;
  for (int i = 0; i < 5; ++i) set.particles.push_back(disk(i + 1, 1.0 + 0.1 * i, 0.05));
  for (int i = 0; i < 4; ++i) set.bonds.push_back({i + 1, i + 2, 0});
  const double k = bond_section<2>(law, 0.1, 0.05, 0.05).kn;

  // omega² = 4·k/m, so dt = 2/omega.
  EXPECT_NEAR(limit(step_limits(model, set), "bond glue, stretching"), std::sqrt(mass(0.05) / k),
              1e-9);
}

TEST(StepLimits, ComeSmallestFirst) {
  Model model = model_of(1);
  model.contacts.constants[0].cn.constant = 400.0;
  model.contacts.constants[0].kt = 2e4;

  const auto limits = step_limits(model, {{disk(1, 1, 0.05), disk(2, 2, 0.05)}, {}});

  EXPECT_GE(limits.size(), 3U);
  EXPECT_TRUE(std::is_sorted(limits.begin(), limits.end(),
                             [](const auto& a, const auto& b) { return a.step < b.step; }));
}

TEST(CheckTimeStep, NamesTheLimitAndALargestStepThatWouldDo) {
  Model model = model_of(1);
  model.time.place = {"case.toml", 7, 8};
  const auto limits = step_limits(model, {{disk(1, 1, 0.05), disk(2, 2, 0.05)}, {}});
  model.time.step = 2.0 * limits.front().step;

  try {
    check_time_step(model, limits);
    FAIL() << "an unstable step was accepted";
  } catch (const InputError& e) {
    const std::string text = e.what();
    EXPECT_NE(text.find("case.toml"), std::string::npos) << text;
    EXPECT_NE(text.find("contact a–a"), std::string::npos) << text;
    const double told = std::stod(text.substr(text.find("use at most ") + 12));
    EXPECT_LE(told, limits.front().step);
    EXPECT_GT(told, 0.98 * limits.front().step);
  }
}

TEST(CheckTimeStep, LetsAnUnstableStepPassWhereTheDeckAllowsIt) {
  Model model = model_of(1);
  const auto limits = step_limits(model, {{disk(1, 1, 0.05), disk(2, 2, 0.05)}, {}});
  model.time.step = 2.0 * limits.front().step;
  model.time.allow_unstable = true;

  EXPECT_NO_THROW(check_time_step(model, limits));
}

TEST(StepLimits, OfHeatAreTheCapacityOverAsManyContactsAsFit) {
  Model model = model_of(1);
  model.heat.is_on = true;
  model.limits.overlap_error = 0.5;
  model.materials[0].conductivity = 2.0;
  model.materials[0].heat_capacity = 1e-6;
  const ParticleSet set{{disk(1, 1, 0.1), disk(2, 2, 0.05)}, {}};

  const auto limits = step_limits(model, set);

  const double reduced = 1.0 / (1.0 / 0.05 + 1.0 / 0.1);
  const double h = 2.0 * 2.0 * std::sqrt(reduced * 0.5 * 0.05) / 0.15;
  EXPECT_NEAR(limit(limits, "heat in a") / (1e-6 * mass(0.05) / (6.0 * h)), 1.0, 1e-12);
  EXPECT_EQ(limits.front().what, "heat in a");
  model.time.step = 2.0 * limits.front().step;
  EXPECT_THROW(check_time_step(model, limits), InputError);
}

}  // namespace
}  // namespace barchan
