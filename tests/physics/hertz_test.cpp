// Spheres by Hertz and Mindlin against closed forms and the benchmark of Chung & Ooi 2011
// (doi:10.1007/s10035-011-0277-0), whose numbers of tests are kept.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "physics_case.hpp"

namespace barchan {
namespace {

constexpr double kPi = std::numbers::pi;

struct Solid {
  double density, young_modulus, poisson_ratio;
};

std::string material(const std::string& name, const Solid& m, const std::string& more) {
  return fmt::format(
      "[[material]]\nname = \"{}\"\ndensity = {}\nyoung_modulus = {}\npoisson_ratio = {}\n{}\n",
      name, m.density, m.young_modulus, m.poisson_ratio, more);
}

std::string head(double dt, const std::string& contact) {
  return fmt::format(R"(
dimension = 3
[domain]
lo = [-1.0, -1.0, -1.0]
hi = [1.0, 1.0, 1.0]
[time]
step = {}
steps = 100000000
[contact]
model = "hertz"
{}
)",
                     dt, contact);
}

std::string grain(double radius, double z, const Vec3& v, const Vec3& omega = Vec3::Zero()) {
  return fmt::format(
      "{{ radius = {}, position = [0.0, 0.0, {:.17g}], velocity = [{:.17g}, {:.17g}, {:.17g}], "
      "omega = [{:.17g}, {:.17g}, {:.17g}] }},\n",
      radius, z, v[0], v[1], v[2], omega[0], omega[1], omega[2]);
}

std::string source(const std::string& grains) {
  return "[[particles]]\nkind = \"list\"\nmaterial = \"m\"\nparticle = [\n" + grains + "]\n";
}

std::string rigid_floor(const std::string& more) {
  return "[[material]]\nname = \"wall\"\ndensity = 1.0\nrigid = true\n" + more +
         "\n[[wall]]\nname = \"floor\"\nmaterial = \"wall\"\npoint = [0.0, 0.0, 0.0]\n"
         "normal = [0.0, 0.0, 1.0]\n";
}

/// What comes of a contact.
struct Collision {
  double overlap = 0.0, force = 0.0, duration = 0.0;  ///< largest overlap and force
};

/// Runs until the contact has ended. @param mass  on which the force acts
Collision collide(Simulation& simulation, double mass, double dt) {
  Collision c;
  double before = test::particle(simulation, 1).velocity[2];
  bool was_touching = false;
  while (true) {
    simulation.run(1);
    const Measures m = simulation.measure();
    const double v = test::particle(simulation, 1).velocity[2];
    c.force = std::max(c.force, mass * std::fabs(v - before) / dt);
    before = v;
    c.overlap = std::max(c.overlap, m.max_overlap);
    const bool is_touching = m.max_overlap > 0.0;  // `contacts` are between particles
    if (is_touching) c.duration += dt;
    if (was_touching && !is_touching) return c;
    was_touching = is_touching;
  }
}

double mass_of(const Solid& m, double radius) {
  return m.density * 4.0 / 3.0 * kPi * radius * radius * radius;
}

void expect_near(const Collision& got, const Collision& wanted) {
  EXPECT_NEAR(got.overlap, wanted.overlap, 1e-3 * wanted.overlap);
  EXPECT_NEAR(got.force, wanted.force, 1e-3 * wanted.force);
  EXPECT_NEAR(got.duration, wanted.duration, 1e-3 * wanted.duration);
}

TEST(ChungOoi, Test1TwoSpheresCollideElastically) {
  struct Case {
    Solid solid;
    Collision wanted;
  };
  const double radius = 0.01, dt = 1e-8;
  for (const auto& [solid, wanted] : {Case{{2800.0, 48e9, 0.2}, {274.1e-6, 10.697e3, 40.34e-6}},
                                      Case{{2500.0, 20e9, 0.25}, {368.3e-6, 7.108e3, 54.20e-6}}}) {
    auto simulation =
        test::simulate(head(dt, "") + material("m", solid, "restitution = 1.0\nfriction = 0.35") +
                       source(grain(radius, -0.0100001, Vec3(0, 0, 10)) +
                              grain(radius, 0.0100001, Vec3(0, 0, -10))));

    expect_near(collide(simulation, mass_of(solid, radius), dt), wanted);
  }
}

TEST(ChungOoi, Test2ASphereMeetsARigidWall) {
  struct Case {
    Solid solid;
    Collision wanted;
  };
  const double radius = 0.1, dt = 2e-7;
  for (const auto& [solid, wanted] : {Case{{2699.0, 70e9, 0.30}, {49.72e-6, 11.370e3, 731.7e-6}},
                                      Case{{1800.0, 40e9, 0.35}, {52.12e-6, 7.233e3, 767.1e-6}}}) {
    auto simulation = test::simulate(head(dt, "") + material("m", solid, "restitution = 1.0") +
                                     rigid_floor("restitution = 1.0") +
                                     source(grain(radius, radius + 1e-9, Vec3(0, 0, -0.2))));

    expect_near(collide(simulation, mass_of(solid, radius), dt), wanted);
  }
}

const Solid kOxide{4000.0, 3.8e11, 0.23};

class Restitution : public testing::TestWithParam<bool> {};

TEST_P(Restitution, ChungOoiTest3IsThatOfTheDeck) {
  const double radius = 2.5e-3, dt = 2e-9;
  for (const double e : {0.05, 0.2, 0.4, 0.6, 0.8, 0.9, 1.0}) {
    const std::string contact = fmt::format("restitution = {}", e);
    auto simulation = test::simulate(head(dt, fmt::format("no_tension = {}", GetParam())) +
                                     material("m", kOxide, contact) + rigid_floor(contact) +
                                     source(grain(radius, radius + 1e-9, Vec3(0, 0, -3.9))));
    simulation.run(20000);

    EXPECT_NEAR(test::particle(simulation, 1).velocity[2] / 3.9, e, 0.002) << e;
  }
}

INSTANTIATE_TEST_SUITE_P(Hertz, Restitution, testing::Bool(), [](const auto& given) {
  return std::string(given.param ? "Clamped" : "Free");
});

struct Rebound {
  double tangential, omega;  ///< speed over the one before, [rad/s]
};

/// Of a sphere on a rigid wall, `degrees` off the normal.
Rebound oblique(double degrees, const std::string& contact) {
  const double radius = 2.5e-3, speed = 3.9, angle = degrees * kPi / 180.0;
  auto simulation = test::simulate(
      head(2e-9, contact + "\nno_tension = false") +
      material("m", kOxide, "restitution = 0.98\nfriction = 0.092") +
      rigid_floor("restitution = 0.98\nfriction = 0.092") +
      source(grain(radius, radius + 1e-9, speed * Vec3(std::sin(angle), 0.0, -std::cos(angle)))));
  simulation.run(static_cast<std::int64_t>(11000.0 / std::pow(std::cos(angle), 0.2)));
  const OwnedParticle p = test::particle(simulation, 1);
  EXPECT_GT(p.velocity[2], 0.9 * speed * std::cos(angle)) << "still in contact";
  return {p.velocity[0] / (speed * std::sin(angle)), p.omega[1]};
}

TEST(ChungOoi, Test4ASphereThatSlidesOnAWall) {
  const double mu = 0.092, e = 0.98, radius = 2.5e-3;
  for (const double degrees : {40.0, 50.0, 60.0, 80.0}) {
    const double angle = degrees * kPi / 180.0;

    const Rebound got = oblique(degrees, "");

    const double tangential = 1.0 - mu * (1.0 + e) / std::tan(angle);
    const double omega = 2.5 * mu * (1.0 + e) * 3.9 * std::cos(angle) / radius;
    EXPECT_NEAR(got.tangential, tangential, 0.002 * tangential) << degrees;
    EXPECT_NEAR(got.omega, omega, 0.01 * omega) << degrees;
  }
}

/// Values of LAMMPS (pair granular, mindlin and mindlin_rescale/force).
TEST(ChungOoi, Test4ASphereThatSticksToAWall) {
  struct Case {
    const char* tangential;
    double degrees;
    Rebound wanted;
  };
  for (const auto& [tangential, degrees, wanted] :
       {Case{"mindlin-displacement", 10.0, {0.703, 201.0}},
        Case{"mindlin-displacement", 20.0, {0.623, 503.4}},
        Case{"mindlin-displacement", 30.0, {0.685, 615.2}}, Case{"mindlin", 10.0, {0.715, 192.9}},
        Case{"mindlin", 20.0, {0.623, 503.3}}, Case{"mindlin", 30.0, {0.684, 615.3}}}) {
    const Rebound got = oblique(degrees, fmt::format("tangential = \"{}\"", tangential));

    EXPECT_NEAR(got.tangential, wanted.tangential, 0.005 * wanted.tangential)
        << tangential << " " << degrees;
    EXPECT_NEAR(got.omega, wanted.omega, 0.005 * wanted.omega) << tangential << " " << degrees;
  }
}

TEST(ChungOoi, Test6ASphereThatSpinsMeetsAWall) {
  const double radius = 0.1, normal = 0.2, mu = 0.4, e = 0.5;
  const std::string contact = "restitution = 0.5\nfriction = 0.4\ntangential_damping_ratio = 0.0";
  for (const double x : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    const double surface = 3.5 * mu * (1.0 + e) * normal / x;
    auto simulation = test::simulate(
        head(5e-7, "no_tension = false") + material("m", {2700.0, 70e9, 0.33}, contact) +
        rigid_floor(contact) +
        source(grain(radius, radius + 1e-8, Vec3(0, 0, -normal), Vec3(0, surface / radius, 0))));
    simulation.run(2200);

    const OwnedParticle p = test::particle(simulation, 1);
    const double after = p.omega[1] * radius - p.velocity[0];
    EXPECT_GT(p.velocity[2], 0.09);
    EXPECT_NEAR(-after / surface, x - 1.0, 0.04) << x;
  }
}

// One particle is held between two fixed ones, as stiff as no impact at the reference speed makes
// contacts: nothing moves, but the step is unstable.
TEST(Hertz, ARunEndsWhereContactsAreTooStiffForItsStep) {
  const std::string deck =
      head(0.015, "reference_speed = 1e-3") +
      material("m", {1000.0, 1e7, 0.25}, "restitution = 0.8\nfriction = 0.3") +
      source(grain(0.1, 0.0, Vec3::Zero())) +
      "[[particles]]\nkind = \"list\"\nmaterial = \"m\"\nfixed = true\nparticle = [\n" +
      grain(0.1, 0.195, Vec3::Zero()) + grain(0.1, -0.195, Vec3::Zero()) + "]\n";
  std::string message;
  try {
    Simulation run = test::simulate(deck);
    run.run(1100);
  } catch (const AgreedError& e) {
    message = e.what();
  }
  for (const char* part : {"at step 10", "time.step = 0.015 s has become unstable: particle 1 at",
                           "overlap by 0.05 of the smaller radius", "reference_speed"})
    EXPECT_NE(message.find(part), std::string::npos) << part << " in " << message;

  Simulation allowed = test::simulate(deck, {"time.allow_unstable=true"});
  EXPECT_EQ(allowed.run(1100), 1100);
}

}  // namespace
}  // namespace barchan
