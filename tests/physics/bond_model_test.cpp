// Bonds between particles of unequal radii against a model written for this test alone: its own
// integrator, angular velocities in place of surface speeds, inertia by the textbook.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "physics_case.hpp"

namespace barchan {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kYoung = 2e6, kRatio = 1.7, kFactor = 0.8, kDamping = 0.15, kDensity = 1000.0;

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Body {
  double radius, mass, inertia;  ///< infinite for a fixed one
  Vec3 x, v, omega;
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
};

/// A beam between two bodies: first and second along its normal.
struct Beam {
  std::size_t first, second;
  double length = 0.0;
  Vec3 shear = Vec3::Zero(), bending = Vec3::Zero();
  double twist = 0.0;
};

struct Motion {
  Vec3 n, slip, turn;
  double distance, parting, arm[2];
};

class BeamModel {
 public:
  BeamModel(int dimension, std::vector<Body> bodies, std::vector<Beam> beams)
      : dimension_(dimension), bodies_(std::move(bodies)), beams_(std::move(beams)) {
    for (Beam& beam : beams_) beam.length = (bodies_[beam.second].x - bodies_[beam.first].x).norm();
  }

  void step(double dt) {
    const bool is_first = std::exchange(is_first_, false);
    for (Body& body : bodies_) body.force = body.torque = Vec3::Zero();
    for (Beam& beam : beams_) pull(beam, is_first ? 0.0 : dt);
    for (Body& body : bodies_) {
      body.v += body.force * ((is_first ? 0.5 : 1.0) * dt / body.mass);
      body.omega += body.torque * ((is_first ? 0.5 : 1.0) * dt / body.inertia);
      body.x += body.v * dt;
    }
  }

  [[nodiscard]] const std::vector<Body>& bodies() const { return bodies_; }

 private:
  static Motion motion_of(const Body& a, const Body& b) {
    Motion m;
    const Vec3 d = b.x - a.x;
    m.distance = d.norm();
    m.n = d / m.distance;
    m.arm[0] = m.distance * a.radius / (a.radius + b.radius);
    m.arm[1] = m.distance - m.arm[0];
    const Vec3 at_a = a.v + cross(a.omega, m.arm[0] * m.n);
    const Vec3 at_b = b.v + cross(b.omega, -m.arm[1] * m.n);
    m.parting = (b.v - a.v).dot(m.n);
    m.slip = (at_b - at_a) - (at_b - at_a).dot(m.n) * m.n;
    m.turn = b.omega - a.omega;
    return m;
  }

  /// Carries a vector with the bond as it turns: that of disks keeps its length, that of spheres
  /// loses its part along the bond.
  [[nodiscard]] Vec3 carried(const Vec3& old, const Vec3& n) const {
    if (dimension_ == 3) return old - old.dot(n) * n;
    const Vec3 t(-n[1], n[0], 0.0);
    return std::copysign(old.norm(), old.dot(t)) * t;
  }

  void pull(Beam& beam, double dt) {
    Body &a = bodies_[beam.first], &b = bodies_[beam.second];
    const Motion m = motion_of(a, b);
    const double R = kFactor * std::min(a.radius, b.radius);
    const bool is_flat = dimension_ == 2;
    const double area = is_flat ? 2.0 * R : kPi * R * R;
    const double second = is_flat ? std::pow(2.0 * R, 3) / 12.0 : kPi * std::pow(R, 4) / 4.0;
    const double k = kYoung / beam.length;
    const double stretching = k * area, shearing = k * area / kRatio, bending = k * second,
                 twisting = k / kRatio * kPi * std::pow(R, 4) / 2.0;
    const double mass = 1.0 / (1.0 / a.mass + 1.0 / b.mass);
    const double inertia = 1.0 / (1.0 / a.inertia + 1.0 / b.inertia);
    const auto dashpot = [](double stiffness, double of) {
      return 2.0 * kDamping * std::sqrt(stiffness * of);
    };

    const double twist_rate = is_flat ? 0.0 : m.turn.dot(m.n);
    const Vec3 bend_rate = m.turn - twist_rate * m.n;
    beam.shear = carried(beam.shear, m.n) + shearing * dt * m.slip;
    if (!is_flat) beam.bending = carried(beam.bending, m.n);
    beam.bending += bending * dt * bend_rate;
    beam.twist += twisting * dt * twist_rate;

    const Vec3 across = beam.shear + dashpot(shearing, mass) * m.slip;
    const Vec3 along =
        (stretching * (m.distance - beam.length) + dashpot(stretching, mass) * m.parting) * m.n;
    const Vec3 moment = beam.bending + dashpot(bending, inertia) * bend_rate +
                        (beam.twist + dashpot(twisting, inertia) * twist_rate) * m.n;
    a.force += along + across;
    b.force -= along + across;
    a.torque += cross(m.arm[0] * m.n, across) + moment;
    b.torque += cross(-m.arm[1] * m.n, -across) - moment;
  }

  int dimension_;
  bool is_first_ = true;
  std::vector<Body> bodies_;
  std::vector<Beam> beams_;
};

/// A crooked chain of unequal particles, the last one fixed.
std::vector<ParticleData> chain_of(int dimension) {
  const std::array<double, 4> radii{0.1, 0.06, 0.14, 0.05};
  const std::array<Vec3, 4> steps{Vec3(0.0, 0.0, 0.0), Vec3(0.8, 0.6, 0.0), Vec3(0.6, -0.64, 0.48),
                                  Vec3(0.28, 0.0, 0.96)};
  std::vector<ParticleData> chain;
  Vec3 at = Vec3::Zero();
  for (std::size_t k = 0; k < radii.size(); ++k) {
    const auto s = static_cast<double>(k);
    Vec3 way = steps[k], v(0.3 - 0.2 * s, 0.1 * s, 0.2),
         omega(1.0 - s, 2.0 - 0.5 * s, 3.0 - 2.0 * s);
    if (dimension == 2) {
      way[2] = v[2] = omega[0] = omega[1] = 0.0;
      if (k > 0) way /= way.norm();
    }
    if (k > 0) at += (radii[k - 1] + radii[k]) * way;
    const bool is_fixed = k + 1 == radii.size();
    ParticleData p;
    p.id = static_cast<std::int64_t>(k) + 1;
    p.radius = radii[k];
    p.density = kDensity;
    p.position = at;
    p.velocity = is_fixed ? Vec3::Zero() : v;
    p.omega = is_fixed ? Vec3::Zero() : omega;
    p.fixed = is_fixed;
    chain.push_back(p);
  }
  return chain;
}

Body body_of(const ParticleData& p, int dimension) {
  const double r = p.radius;
  const double mass = kDensity * (dimension == 2 ? kPi * r * r : 4.0 / 3.0 * kPi * r * r * r);
  const double inertia = (dimension == 2 ? 0.5 : 0.4) * mass * r * r;
  const double factor = p.fixed ? std::numeric_limits<double>::infinity() : 1.0;
  return {r, factor * mass, factor * inertia, p.position, p.velocity, p.omega};
}

Simulation bonded(int dimension, double dt, double damping, ParticleSet set) {
  const std::string z = dimension == 2 ? "" : ", 1.0";
  const Deck deck = parse_deck(
      fmt::format(R"(
dimension = {0}
[domain]
lo = [-1.0, -1.0{1}]
hi = [1.0, 1.0{2}]
[time]
step = {3}
steps = 1000000
[[material]]
name = "m"
density = {4}
normal_stiffness = 1e3
[[bond]]
name = "beam"
young_modulus = {5}
stiffness_ratio = {6}
radius_factor = {7}
damping_ratio = {8}
[[particles]]
kind = "list"
material = "m"
particle = [{{ position = {9}, radius = 0.1 }}]
)",
                  dimension, dimension == 2 ? "" : ", -1.0", z, dt, kDensity, kYoung, kRatio,
                  kFactor, damping, dimension == 2 ? "[0.0, 0.0]" : "[0.0, 0.0, 0.0]"),
      "test.toml");
  RunOptions options;
  options.threads = 1;
  return {deck.model, std::move(set), MPI_COMM_WORLD, options};
}

class BondedChain : public testing::TestWithParam<int> {};

TEST_P(BondedChain, MovesAsAnIndependentModelOfBeams) {
  const int dimension = GetParam();
  const double dt = 2e-5;
  const auto chain = chain_of(dimension);
  std::vector<Body> bodies;
  for (const ParticleData& p : chain) bodies.push_back(body_of(p, dimension));
  BeamModel model(dimension, bodies, {{0, 1}, {1, 2}, {2, 3}});
  auto simulation = bonded(dimension, dt, kDamping, {chain, {{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}});

  for (int step = 0; step < 3000; ++step) model.step(dt);
  simulation.run(3000);

  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const Body& want = model.bodies()[k];
    const OwnedParticle got = test::particle(simulation, static_cast<std::int64_t>(k) + 1);
    EXPECT_LT((got.position - want.x).norm(), 1e-9 * 0.1) << k;
    EXPECT_LT((got.velocity - want.v).norm(), 1e-9 * 0.5) << k;
    EXPECT_LT((got.omega - want.omega).norm(), 1e-9 * 5.0) << k;
  }
  EXPECT_GT((test::particle(simulation, 1).position - chain[0].position).norm(), 1e-3);
}

TEST_P(BondedChain, KeepsItsEnergyWhereNothingDamps) {
  auto chain = chain_of(GetParam());
  for (ParticleData& p : chain) p.omega *= 20.0;  // so that twist and bending weigh
  auto simulation = bonded(GetParam(), 1e-5, 0.0, {chain, {{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}});
  simulation.run(20);
  const double energy = test::total_energy(simulation);
  double elastic = 0.0;

  for (int sample = 0; sample < 30; ++sample) {
    simulation.run(74);
    elastic = std::max(elastic, simulation.measure().elastic.value());

    EXPECT_NEAR(test::total_energy(simulation), energy, 2e-3 * energy) << sample;
  }
  EXPECT_GT(elastic, 0.3 * energy);
}

INSTANTIATE_TEST_SUITE_P(Dimension, BondedChain, testing::Values(2, 3),
                         [](const auto& given) { return fmt::format("In{}D", given.param); });

}  // namespace
}  // namespace barchan
