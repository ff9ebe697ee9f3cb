// Conduction against closed forms, and what it keeps.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "physics_case.hpp"

namespace barchan {
namespace {

constexpr double kRadius = 0.01, kDepth = 0.0005, kConductivity = 40.0;  // [m, m, W/(m·K)]
constexpr double kCapacity = 100.0, kDensity = 2000.0;                   // [J/(kg·K), kg/m³]

std::string head(int dimension, double dt, const std::string& more) {
  const char* third = dimension == 2 ? "" : ", 0.0";
  return fmt::format(R"(
dimension = {0}
[domain]
lo = [0.0, 0.0{1}]
hi = [1.0, 0.1{2}]
[time]
step = {3}
steps = 1000000
[limits]
overlap_warning = 0.06
overlap_error = 0.06
[heat]
temperature = 300.0
[[material]]
name = "m"
density = {4}
conductivity = {5}
heat_capacity = {6}
{7}
)",
                     dimension, third, dimension == 2 ? "" : ", 0.1", dt, kDensity, kConductivity,
                     kCapacity, more);
}

std::string at(int dimension, double x, const std::string& more = "") {
  return fmt::format("{{ position = [{:.17g}, 0.05{}], radius = {}{} }},\n", x,
                     dimension == 2 ? "" : ", 0.05", kRadius, more);
}

std::string source(const std::string& particles) {
  return "[[particles]]\nkind = \"list\"\nmaterial = \"m\"\nparticle = [\n" + particles + "]\n";
}

/// [W/K] @param radius  reduced. @param reach  of the two
double conductance_of(int dimension, double radius, double reach) {
  const double h = 2.0 * kConductivity * std::sqrt(radius * kDepth);
  return dimension == 2 ? h / reach : h;
}
double between_particles(int dimension) {
  return conductance_of(dimension, kRadius / 2.0, 2.0 * kRadius);
}

/// m·c [J/K]
double capacity_of(int dimension) {
  const double disk = std::numbers::pi * kRadius * kRadius;
  return kDensity * kCapacity * (dimension == 2 ? disk : 4.0 / 3.0 * kRadius * disk);
}

const std::string kSoft = "normal_stiffness = 1e-15";

class Heat : public testing::TestWithParam<int> {};

TEST_P(Heat, LevelsTwoParticlesExponentially) {
  const int dim = GetParam();
  const double rate = 2.0 * between_particles(dim) / capacity_of(dim), dt = 1e-4 / rate;
  auto simulation =
      test::simulate(head(dim, dt, kSoft) + source(at(dim, 0.05, ", temperature = 400.0") +
                                                   at(dim, 0.05 + 2.0 * kRadius - kDepth)));

  simulation.run(10000);

  EXPECT_NEAR(test::particle(simulation, 1).temperature, 350.0 + 50.0 * std::exp(-1.0), 2e-3);
  EXPECT_NEAR(test::particle(simulation, 2).temperature, 350.0 - 50.0 * std::exp(-1.0), 2e-3);
  const double explicit_euler = 350.0 + 50.0 * std::pow(1.0 - 1e-4, 10000);
  EXPECT_NEAR(test::particle(simulation, 1).temperature, explicit_euler, 1e-8);
}

/// Ten in a row that press each other and both walls alike.
std::string row_of(int dimension, const std::string& left, const std::string& right) {
  constexpr int kCount = 10;
  const double step = 2.0 * kRadius - kDepth, first = 0.2 + kRadius - kDepth;
  std::string particles;
  for (int p = 0; p < kCount; ++p) particles += at(dimension, first + step * p);
  const double end = first + step * (kCount - 1) + kRadius - kDepth;
  const std::string rest = dimension == 2 ? ", 0.0]" : ", 0.0, 0.0]";
  const double dt = 0.04 * capacity_of(dimension) / between_particles(dimension);
  return head(dimension, dt, kSoft) +
         fmt::format(
             "[[wall]]\nname = \"left\"\nmaterial = \"m\"\npoint = [0.2{0}\nnormal = [1.0{0}\n{1}\n"
             "[[wall]]\nname = \"right\"\nmaterial = \"m\"\npoint = [{2:.17g}{0}\nnormal = "
             "[-1.0{0}\n{3}\n",
             rest, left, end, right) +
         source(particles);
}

TEST_P(Heat, FallsLinearlyBetweenAHotAndAColdWall) {
  const int dim = GetParam();
  auto simulation = test::simulate(row_of(dim, "temperature = 400.0", "temperature = 300.0"));

  simulation.run(15000);

  const double h = between_particles(dim), wall = conductance_of(dim, kRadius, kRadius);
  const double flow = 100.0 / (2.0 / wall + 9.0 / h);
  for (int p = 0; p < 10; ++p)
    EXPECT_NEAR(test::particle(simulation, p + 1).temperature, 400.0 - flow * (1.0 / wall + p / h),
                1e-5);
  (void)simulation.measure();
  EXPECT_NEAR(simulation.walls()[0].heat_flow / flow, 1.0, 1e-6);
  EXPECT_NEAR(simulation.walls()[1].heat_flow / flow, -1.0, 1e-6);
}

TEST_P(Heat, OfAFluxGoesThroughARowIntoAColdWall) {
  const int dim = GetParam();
  auto simulation = test::simulate(row_of(dim, "heat_flux = 5000.0", "temperature = 300.0"));

  simulation.run(1);
  const double flow = 5000.0 * (dim == 2 ? 2.0 * kRadius : std::numbers::pi * kRadius * kRadius);
  const double dt = simulation.model().time.step;
  EXPECT_NEAR(test::particle(simulation, 1).temperature, 300.0 + dt * flow / capacity_of(dim),
              1e-9);
  simulation.run(50000);

  (void)simulation.measure();
  EXPECT_NEAR(simulation.walls()[0].heat_flow, flow, 1e-12 * flow);
  EXPECT_NEAR(simulation.walls()[1].heat_flow / flow, -1.0, 1e-6);
}

/// A gas that collides; some of it is hot.
std::string gas(int dimension) {
  const char* third = dimension == 2 ? "" : ", 0.0";
  const char* top = dimension == 2 ? "" : ", 0.5";
  return fmt::format(R"(
dimension = {0}
[domain]
lo = [0.0, 0.0{1}]
hi = [1.0, 0.5{2}]
periodic = ["x", "y"{3}]
[time]
step = 1e-4
steps = 100000
[heat]
[[material]]
name = "m"
density = 1000.0
normal_stiffness = 1e4
conductivity = {4}
heat_capacity = 10.0
[[particles]]
kind = "lattice"
region = {{ lo = [0.0, 0.0{1}], hi = [0.5, 0.5{2}] }}
spacing = 0.09
radius = [0.03, 0.045]
velocity = [1.0, 0.2{1}]
material = "m"
temperature = 700.0
[[particles]]
kind = "lattice"
region = {{ lo = [0.5, 0.0{1}], hi = [1.0, 0.5{2}] }}
spacing = 0.09
radius = [0.03, 0.045]
material = "m"
)",
                     dimension, third, top, dimension == 2 ? "" : ", \"z\"",
                     dimension == 2 ? 3e4 : 6e3);
}

TEST_P(Heat, IsKeptToTheLastBitOrTwoOverThousandsOfStepsOfAGas) {
  auto simulation = test::simulate(gas(GetParam()));
  const Measures before = simulation.measure();

  simulation.run(5000);

  const Measures after = simulation.measure();
  EXPECT_NEAR(after.heat.value() / before.heat.value(), 1.0, 5e-16);
  EXPECT_LT(after.max_temperature, 699.99) << "some has flown";
  EXPECT_GT(after.min_temperature, 293.14);
  EXPECT_NEAR(after.mean_temperature(), before.mean_temperature(), 1e-12);
}

TEST_P(Heat, FlowsThatADoubleWouldLoseAddUp) {
  const int dim = GetParam();
  const double rate = 2.0 * between_particles(dim) / capacity_of(dim), dt = 1e-10 / rate;
  auto simulation =
      test::simulate(head(dim, dt, kSoft) + source(at(dim, 0.05, ", temperature = 300.0001") +
                                                   at(dim, 0.05 + 2.0 * kRadius - kDepth)));

  simulation.run(20000);  // each step changes a temperature by 5e-15 K, a tenth of its last bit

  EXPECT_NEAR((test::particle(simulation, 2).temperature - 300.0) / (20000 * 1e-10 * 5e-5), 1.0,
              1e-3);
}

INSTANTIATE_TEST_SUITE_P(Dimensions, Heat, testing::Values(2, 3));

TEST(HertzHeat, FlowsThroughTheCircleOfTheContact) {
  for (const bool attracts : {false, true}) {
    SCOPED_TRACE(attracts);
    const double dt = 1e-7;
    auto simulation = test::simulate(
        head(3, dt,
             "young_modulus = 1e6\npoisson_ratio = 0.25\nrestitution = 0.9\n" +
                 std::string(attracts ? "surface_energy = 1.0\n" : "")) +
        "[contact]\nmodel = \"" + (attracts ? "jkr" : "hertz") + "\"\n" +
        source(at(3, 0.05, ", temperature = 400.0") + at(3, 0.05 + 2.0 * kRadius - kDepth)));

    simulation.run(1);

    const double flow = (400.0 - test::particle(simulation, 1).temperature) * capacity_of(3) / dt;
    const double radius = flow / (100.0 * 2.0 * kConductivity);
    const double reduced = kRadius / 2.0, young = 1e6 / (2.0 * (1.0 - 0.0625));
    // Of JKR the overlap says a: a²/R − √(4π·γ_12·a/E*), γ_12 of both surfaces, twice gamma.
    const double overlap = radius * radius / reduced -
                           (attracts ? std::sqrt(4.0 * std::numbers::pi * radius / young) : 0.0);
    EXPECT_NEAR(overlap / kDepth, 1.0, 1e-6);
  }
}

TEST(HeatOfJkr, FlowsAlsoWhereAContactHoldsBeyondTouch) {
  const std::string deck =
      head(3, 1e-6,
           "young_modulus = 1e5\npoisson_ratio = 0.25\nrestitution = 0.9\nsurface_energy = 5.0\n") +
      "[contact]\nmodel = \"jkr\"\n" +
      source(at(3, 0.05, ", velocity = [-0.5, 0.0, 0.0], temperature = 400.0") +
             at(3, 0.05 + 2.0 * kRadius - 1e-5));
  auto simulation = test::simulate(deck);
  const auto gap = [&] {
    return test::particle(simulation, 2).position[0] - test::particle(simulation, 1).position[0] -
           2.0 * kRadius;
  };
  while (gap() < 2e-5) simulation.run(1);
  const double before = test::particle(simulation, 2).temperature;

  simulation.run(10);

  EXPECT_GT(test::particle(simulation, 2).temperature, before + 1e-6);
}

TEST(HeatOfFixedParticles, FlowsFromWallsToo) {
  auto simulation = test::simulate(row_of(3, "temperature = 400.0", "temperature = 300.0"),
                                   {"particles.1.fixed=true"});

  simulation.run(100);

  EXPECT_GT(test::particle(simulation, 1).temperature, 399.0);
  EXPECT_EQ(test::particle(simulation, 5).temperature, 300.0) << "two fixed ones are no pair";
}

TEST_P(Heat, OfACollisionWarmsBothAlikeByWhatTheyLose) {
  const int dim = GetParam();
  const std::string still = dim == 2 ? ", 0.0]" : ", 0.0, 0.0]";
  auto simulation = test::simulate(
      head(dim, 1e-6, "normal_stiffness = 1e5\nrestitution = 0.6\n") +
          source(at(dim, 0.1, ", velocity = [2.0" + still) +
                 at(dim, 0.1 + 2.0 * kRadius + 1e-4, ", temperature = 310.0")),
      {"heat.dissipation=true", "material.m.conductivity=1e-9", "limits.overlap_error=1.0"});
  const Measures before = simulation.measure();

  simulation.run(10000);

  const Measures after = simulation.measure();
  const double lost = before.kinetic.value() - after.kinetic.value();
  EXPECT_NEAR(lost / before.kinetic.value(), 0.5 * (1.0 - 0.36), 1e-3);
  EXPECT_NEAR((after.heat.value() - before.heat.value()) / lost, 1.0, 3e-3);
  for (const double start : {300.0, 310.0}) {
    const double now = test::particle(simulation, start == 300.0 ? 1 : 2).temperature;
    EXPECT_NEAR((now - start) * capacity_of(dim) / (0.5 * lost), 1.0, 3e-3);
  }
}

TEST_P(Heat, AndMechanicalEnergyOfAGasAreTheSameThroughout) {
  auto simulation = test::simulate(
      gas(GetParam()),
      {"heat.dissipation=true", "material.m.restitution=0.7", "material.m.friction=0.4",
       "material.m.tangential_stiffness=5e3", "material.m.tangential_damping=1.0"});
  const Measures before = simulation.measure();
  const auto mechanical = [](const Measures& m) { return m.kinetic.value() + m.elastic.value(); };

  simulation.run(5000);

  const Measures after = simulation.measure();
  const double lost = mechanical(before) - mechanical(after);
  EXPECT_GT(lost, 0.3 * mechanical(before));
  EXPECT_NEAR((after.heat.value() - before.heat.value()) / lost, 1.0, 5e-3);
}

TEST(HeatOfSliding, AtAWallAllWarmsTheParticle) {
  auto simulation = test::simulate(
      head(3, 1e-5,
           "normal_stiffness = 1e5\ntangential_stiffness = 5e4\nfriction = 0.3\n"
           "restitution = 0.2\ntangential_damping = 20.0\n") +
          "[[wall]]\nname = \"floor\"\nmaterial = \"m\"\npoint = [0.0, 0.0, 0.0]\nnormal = "
          "[0.0, 0.0, 1.0]\n[[particles]]\nkind = \"list\"\nmaterial = \"m\"\nparticle = [{ "
          "position = [0.1, 0.05, 0.0099992], radius = 0.01, velocity = [1.0, 0.0, 0.0] }]\n",
      {"heat.dissipation=true", "gravity=[0.0, 0.0, -10.0]"});
  const double start = simulation.measure().kinetic.value();

  simulation.run(20000);

  const Measures after = simulation.measure();
  EXPECT_NEAR(after.kinetic.value() / start, 5.0 / 7.0, 1e-3) << "it rolls";
  EXPECT_NEAR((test::particle(simulation, 1).temperature - 300.0) * capacity_of(3) / start,
              2.0 / 7.0, 1e-3);
}

TEST_P(Heat, IsReadAndSetByCallers) {
  const int dim = GetParam();
  const double rate = 2.0 * between_particles(dim) / capacity_of(dim);
  auto simulation = test::simulate(
      head(dim, 1e-4 / rate, kSoft) +
      source(at(dim, 0.05) + at(dim, 0.05 + 2.0 * kRadius - kDepth, ", temperature = 320.0")));
  EXPECT_EQ(simulation.gather(ParticleField::Temperature).values,
            (std::vector<double>{300.0, 320.0}));

  const std::vector<std::int64_t> first{1};
  simulation.scatter(ParticleField::Temperature, first, std::vector<double>{400.0});
  simulation.run(10000);

  EXPECT_NEAR(test::particle(simulation, 1).temperature, 360.0 + 40.0 * std::exp(-1.0), 2e-3);
  const auto refused = [&](const std::vector<double>& values) {
    EXPECT_THROW(simulation.scatter(ParticleField::Temperature, first, values), InputError);
  };
  refused({-1.0});
  refused({1.0, 2.0, 3.0});
}

}  // namespace
}  // namespace barchan
