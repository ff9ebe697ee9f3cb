// Trajectories of an independent code (LAMMPS; tests/physics/reference holds its inputs and makes
// them anew): equality between ranks says nothing of a law that is wrong everywhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <barchan/core/laws/restitution.hpp>

#include "physics_case.hpp"

namespace barchan {
namespace {

namespace fs = std::filesystem;

constexpr double kTolerance = 1e-9;

fs::path folder_of(const std::string& name) {
  return fs::path(BARCHAN_TREE) / "tests/physics/reference" / name;
}

/// A particle at a step; velocities half a step before.
struct State {
  std::int64_t id;
  Vec3 position, velocity, omega;
};

std::vector<State> read_states(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  std::vector<State> states;
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    State s{};
    words >> s.id;
    for (Vec3* v : {&s.position, &s.velocity, &s.omega}) words >> (*v)[0] >> (*v)[1] >> (*v)[2];
    states.push_back(s);
  }
  return states;
}

/// step_N.csv by N.
std::map<std::int64_t, std::vector<State>> read_reference(const std::string& name) {
  std::map<std::int64_t, std::vector<State>> reference;
  for (const auto& entry : fs::directory_iterator(folder_of(name))) {
    const std::string file = entry.path().filename().string();
    if (file.starts_with("step_")) reference[std::stoll(file.substr(5))] = read_states(entry);
  }
  return reference;
}

double largest(const std::vector<State>& states, Vec3 State::*what) {
  double most = 0.0;
  for (const State& s : states) most = std::max(most, (s.*what).cwiseAbs().maxCoeff());
  return most;
}

/// Largest difference over a grain's radius, the largest velocity and the largest spin of all.
double difference(const Simulation& simulation, const std::vector<State>& reference) {
  std::map<std::int64_t, OwnedParticle> got;
  simulation.for_each_owned([&](const OwnedParticle& p) { got.emplace(p.id, p); });
  const double v = largest(reference, &State::velocity), omega = largest(reference, &State::omega);
  double most = got.size() == reference.size() ? 0.0 : 1.0;
  for (const State& s : reference) {
    const OwnedParticle& p = got.at(s.id);
    const double turned = (p.omega - s.omega).cwiseAbs().maxCoeff();
    most = std::max({most, (p.position - s.position).cwiseAbs().maxCoeff() / p.radius,
                     (p.velocity - s.velocity).cwiseAbs().maxCoeff() / v,
                     omega > 0.0 ? turned / omega : turned});
  }
  return most;
}

std::string deck_of(const std::string& name) {
  std::ifstream file(folder_of(name) / "deck.toml");
  return {std::istreambuf_iterator<char>(file), {}};
}

void expect_reference(const std::string& name, const std::string& deck) {
  auto simulation = test::simulate(deck, {}, (folder_of(name) / "deck.toml").string());
  const auto reference = read_reference(name);
  ASSERT_GE(reference.size(), 2u);
  for (const auto& [step, states] : reference) {
    simulation.run(step - simulation.step());

    EXPECT_LT(difference(simulation, states), kTolerance) << name << ", step " << step;
  }
}

class Reference : public testing::TestWithParam<const char*> {};

TEST_P(Reference, IsReproduced) {
  expect_reference(GetParam(), deck_of(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Lammps, Reference,
                         testing::Values("pairs_3d", "pairs_3d_clamped", "pairs_2d",
                                         "pairs_2d_clamped", "walls_3d", "walls_2d", "heap_3d",
                                         "heap_2d", "hertz_pairs_3d", "hertz_head_on_3d",
                                         "hertz_walls_3d"),
                         [](const auto& given) { return std::string(given.param); });

void replace(std::string& text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
}

/// These pairs have one effective mass, so that their rates can be said as coefficients or, along
/// the normal, as a restitution.
class OneEffectiveMass : public testing::TestWithParam<int> {
 protected:
  std::string name = fmt::format("pairs_{}d_clamped", GetParam());
  double kn = GetParam() == 2 ? 4e7 : 8e3, cn_rate = GetParam() == 2 ? 600.0 : 25.0;
  double ct_rate = GetParam() == 2 ? 300.0 : 12.0;

  [[nodiscard]] double reduced_mass() const {
    const auto mass = [&](double r) {
      return 1000.0 * std::numbers::pi * r * r * (GetParam() == 2 ? 1.0 : 4.0 / 3.0 * r);
    };
    return mass(0.1) * mass(0.06) / (mass(0.1) + mass(0.06));
  }
  [[nodiscard]] std::string deck_with(const std::string& normal_damping) const {
    std::string deck = deck_of(name);
    replace(deck, fmt::format("normal_damping_rate = {:.1f}", cn_rate), normal_damping);
    replace(deck, fmt::format("tangential_damping_rate = {:.1f}", ct_rate),
            fmt::format("tangential_damping = {:.17g}", ct_rate * reduced_mass()));
    return deck;
  }
};

TEST_P(OneEffectiveMass, IsReproducedByCoefficients) {
  expect_reference(name,
                   deck_with(fmt::format("normal_damping = {:.17g}", cn_rate * reduced_mass())));
}

TEST_P(OneEffectiveMass, IsReproducedByARestitution) {
  const double zeta = 0.5 * cn_rate * std::sqrt(reduced_mass() / kn);

  expect_reference(name,
                   deck_with(fmt::format("restitution = {:.17g}", restitution_at(zeta, true))));
}

INSTANTIATE_TEST_SUITE_P(Lammps, OneEffectiveMass, testing::Values(2, 3),
                         [](const auto& given) { return fmt::format("In{}D", given.param); });

}  // namespace
}  // namespace barchan
