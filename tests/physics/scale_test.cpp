// Nothing knows a length of its own: scaled by a power of two, a run gives scaled bits.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "physics_case.hpp"

namespace barchan {
namespace {

/// A heap under a loaded plate between walls, with everything that has a unit scaled: lengths by
/// 2^k, times by 2^j, masses by 2^m.
std::string heap(int dimension, int k, int j, int m) {
  const auto length = [&](double x) { return fmt::format("{:.17g}", std::ldexp(x, k)); };
  const auto scaled = [](double x, int power) {
    return fmt::format("{:.17g}", std::ldexp(x, power));
  };
  const auto vector = [&](double x, double y, double z) {
    return dimension == 2 ? fmt::format("[{}, {}]", length(x), length(z))
                          : fmt::format("[{}, {}, {}]", length(x), length(y), length(z));
  };
  const auto plain = [&](double x, double y, double z) {
    return dimension == 2 ? fmt::format("[{}, {}]", x, z) : fmt::format("[{}, {}, {}]", x, y, z);
  };
  const std::string gravity = dimension == 2
                                  ? fmt::format("[0.0, {}]", scaled(-9.81, k - 2 * j))
                                  : fmt::format("[0.0, 0.0, {}]", scaled(-9.81, k - 2 * j));
  std::string deck = fmt::format(
      R"(
dimension = {}
gravity = {}
[domain]
lo = {}
hi = {}
periodic = ["x"]
[time]
step = {}
steps = 1000000
[[material]]
name = "m"
density = {}
normal_stiffness = {}
tangential_stiffness = {}
normal_damping = {}
tangential_damping = {}
friction = 0.5
[[particles]]
kind = "packing"
region = {{ lo = {}, hi = {} }}
radius = [{}, {}]
solid_fraction = {}
material = "m"
[[stage]]
name = "fall"
max_time = {}
[[stage]]
name = "load"
local_damping = 0.1
)",
      dimension, gravity, vector(0.0, 0.0, 0.0), vector(1.0, 1.0, 2.0), scaled(1e-4, j),
      scaled(1000.0, m - dimension * k), scaled(1e5, m - 2 * j), scaled(5e4, m - 2 * j),
      scaled(50.0, m - j), scaled(20.0, m - j), vector(0.0, 0.0, 0.1), vector(1.0, 1.0, 1.0),
      length(0.06), length(0.1), dimension == 2 ? 0.7 : 0.4, scaled(0.02, j));
  const auto wall = [&](const std::string& name, const std::string& point,
                        const std::string& normal, const std::string& more) {
    deck += fmt::format("[[wall]]\nname = \"{}\"\npoint = {}\nnormal = {}\nmaterial = \"m\"\n{}\n",
                        name, point, normal, more);
  };
  wall("floor", vector(0.0, 0.0, 0.0), plain(0.0, 0.0, 1.0), "");
  const std::string depth = dimension == 3 ? fmt::format("depth = {}\n", length(0.7)) : "";
  wall("shelf", vector(0.9, 0.5, 0.05), plain(0.0, 0.0, 1.0),
       fmt::format("kind = \"plate\"\nwidth = {}\n{}", length(0.4), depth));
  wall("lid", vector(0.5, 0.5, 1.3), plain(0.0, 0.0, -1.0),
       fmt::format("kind = \"plate\"\nwidth = {}\n{}load = {}\nmass = {}\ndamping = {}\n"
                   "from_stage = \"load\"",
                   length(1.0), depth, scaled(2000.0, dimension == 2 ? m - 2 * j : m - k - 2 * j),
                   scaled(20.0, m), scaled(30.0, m - j)));
  if (dimension == 3) {
    wall("front", vector(0.0, 0.0, 0.0), plain(0.0, 1.0, 0.0), "");
    wall("back", vector(0.0, 1.0, 0.0), plain(0.0, -1.0, 0.0), "");
  }
  return deck;
}

/// Positions in lengths, velocities in lengths over times, and the plate's.
std::vector<double> state_of(int dimension, int k, int j, int m) {
  auto simulation = test::simulate(heap(dimension, k, j, m));
  simulation.run(1500);
  const Measures measures = simulation.measure();
  std::vector<double> state;
  simulation.for_each_owned([&](const OwnedParticle& p) {
    for (int c = 0; c < 3; ++c) {
      state.push_back(std::ldexp(p.position[c], -k));
      state.push_back(std::ldexp(p.velocity[c], j - k));
      state.push_back(std::ldexp(p.omega[c], j));
    }
  });
  for (const WallState& wall : simulation.walls()) {
    state.push_back(std::ldexp(wall.point[dimension - 1], -k));
    state.push_back(std::ldexp(wall.force[dimension - 1], 2 * j - m - k));
    state.push_back(std::ldexp(wall.work, 2 * j - m - 2 * k));
  }
  state.push_back(std::ldexp(measures.kinetic.value(), 2 * j - m - 2 * k));
  state.push_back(std::ldexp(measures.elastic.value(), 2 * j - m - 2 * k));
  return state;
}

void expect_same_scaled(int dimension) {
  const std::vector<double> reference = state_of(dimension, 0, 0, 0);
  const std::size_t after_lid = dimension == 2 ? 2 : 8;  // two energies, and two walls in 3D
  EXPECT_NE(reference[reference.size() - 1 - after_lid], 0.0) << "the lid's work on the heap";
  EXPECT_EQ(state_of(dimension, -30, 0, -10), reference) << "grains of a nanometre";
  EXPECT_EQ(state_of(dimension, 40, 3, 0), reference) << "grains of a planet";
  EXPECT_EQ(state_of(dimension, -120, -60, -200), reference);
  EXPECT_EQ(state_of(dimension, 200, 3, 40), reference) << "energies beyond 1e120 J";
}

TEST(Scale, ADiskHeapOfAnySizeGivesTheSameBits) {
  expect_same_scaled(2);
}

TEST(Scale, ASphereHeapOfAnySizeGivesTheSameBits) {
  expect_same_scaled(3);
}

}  // namespace
}  // namespace barchan
