#include "sample.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <vector>

#include <fmt/format.h>

#include <barchan/core/brick/measure.hpp>
#include <barchan/core/deck/deck.hpp>
#include <barchan/core/generators/make_particles.hpp>
#include <barchan/tasks/forecast.hpp>
#include <barchan/tasks/strip_plan.hpp>

namespace barchan::micro {
namespace {

constexpr const char* kDeck2 = R"(
dimension = 2
gravity = [0.0, -9.81]
domain = {{ lo = [-0.1, -0.1], hi = [{0}, {1}] }}
time = {{ step = 1e-9, steps = 1 }}
contact = {{ no_tension = false }}
[[material]]
name = "soil"
density = 126.0
normal_stiffness = 55000.0
tangential_stiffness = 70.0
normal_damping_rate = 1300.0
tangential_damping_rate = 180.0
friction = 0.5
[[particles]]
kind = "packing"
region = {{ lo = [0.0, 0.0], hi = [{0}, {1}] }}
radius = [0.045, 0.055]
count = {2}
material = "soil"
)";
constexpr const char* kDeck3 = R"(
dimension = 3
gravity = [0.0, 0.0, -1.0]
domain = {{ lo = [-0.1, -0.1, -0.1], hi = [{0}, {1}, {1}] }}
time = {{ step = 1e-9, steps = 1 }}
contact = {{ no_tension = false }}
[[material]]
name = "sphere"
density = 1.89
normal_stiffness = 2e5
tangential_stiffness = 57142.0
normal_damping_rate = 50.0
friction = 0.5
[[particles]]
kind = "packing"
region = {{ lo = [0.0, 0.0, 0.0], hi = [{0}, {1}, {1}] }}
radius = [0.45, 0.55]
count = {2}
material = "sphere"
)";

// Of radii, so that as many touch as in a settled bed; in 3D a fresh packing is close enough.
template <int Dim>
constexpr double kGrowth = Dim == 2 ? 1.01 : 1.0;

/// Sides of a box for so many particles, 2:1 in 2D; solid fractions 0.82 and 0.57.
template <int Dim>
Deck make_deck(std::int64_t count) {
  const double n = static_cast<double>(count);
  const double volume = Dim == 2 ? n * 3.1416 * 0.00251 / 0.82 : n * 0.5236 * 1.01 / 0.57;
  const double high = Dim == 2 ? std::sqrt(volume / 2.0) : std::cbrt(volume);
  const double wide = volume / (Dim == 2 ? high : high * high);
  return parse_deck(fmt::format(fmt::runtime(Dim == 2 ? kDeck2 : kDeck3), wide, high, count),
                    "sample");
}

/// Packings take longer to make than kernels to measure, so each is made once.
template <int Dim>
const ParticleSet& packing(const Deck& deck, std::int64_t count) {
  static std::map<std::int64_t, ParticleSet> made;
  auto at = made.find(count);
  if (at == made.end()) {
    at = made.emplace(count, make_particles(deck.model, deck.sources)).first;
    for (ParticleData& p : at->second.particles) {
      p.radius *= kGrowth<Dim>;
      for (int c = 0; c < Dim; ++c)
        p.velocity[c] = 1e-3 * static_cast<double>((p.id * (7 + 4 * c)) % 11 - 5);
    }
  }
  return at->second;
}

template <int Dim>
void settle(Sample<Dim>& sample) {
  Lane<Dim>&left = *sample.lane, *right = sample.right.get();
  std::vector<std::byte> to_right, to_left;
  std::vector<std::span<const std::byte>> of_left;
  left.rebuild.order();
  if (right != nullptr) {
    right->rebuild.order();
    left.rebuild.pack_ghosts(0, to_right);
    right->rebuild.pack_ghosts(0, to_left);
    of_left.emplace_back(to_left);
    right->lists.list_owned();
    right->rebuild.take_ghosts(std::array{std::span<const std::byte>(to_right)});
    right->rebuild.restore_history();
    right->lists.cut_chunks(1 << 14);
  }
  left.lists.list_owned();
  left.rebuild.take_ghosts(of_left);
  left.rebuild.restore_history();
  left.lists.cut_chunks(std::int64_t{1} << 60);
}

}  // namespace

template <int Dim>
std::unique_ptr<Sample<Dim>> make_sample(std::int64_t count, VectorWidth width, bool has_cut) {
  const Deck deck = make_deck<Dim>(count);
  const ParticleSet& set = packing<Dim>(deck, count);
  auto sample = std::make_unique<Sample<Dim>>();
  World<Dim>& world = sample->world;
  world.skin = default_skin(deck.model, set);
  world.dt = world.last_dt = deck.model.time.step;
  world.num_particles = count;
  world.grid = Grid<Dim>(deck.model.domain, search_reach(deck.model, set, world.skin));
  world.laws = LawTable(deck.model.contacts);
  world.grain = force_grain(deck.model, set);
  world.kernels = make_kernels(Dim, width, world.laws, false, world.grid.box());

  const int slabs = world.grid.num_slabs(), cut = has_cut ? slabs / 2 : slabs;
  std::vector<ParticleData> parts[2];
  for (const ParticleData& p : set.particles)
    parts[world.grid.coordinate(p.position.data(), 0) < cut ? 0 : 1].push_back(p);
  const auto seed = [&](int side, int begin, int end) {
    auto lane = std::make_unique<Lane<Dim>>(world);
    Placement<Dim> at{box_of_slabs(world.grid, begin, end), {}};
    if (has_cut) {
      lane->brick.add_link(side == 0 ? Side::Right : Side::Left);
      at.beyond.push_back(side == 0 ? box_of_slabs(world.grid, cut, slabs)
                                    : box_of_slabs(world.grid, 0, cut));
    }
    const std::vector<char> bonded(parts[side].size(), 0);
    lane->rebuild.seed(at, parts[side], {}, {}, bonded);
    return lane;
  };
  sample->lane = seed(0, 0, cut);
  if (has_cut) sample->right = seed(1, cut, slabs);
  settle(*sample);
  sample->touching = barchan::measure(sample->lane->brick, deck.model.gravity).contacts;
  return sample;
}

template <int Dim>
void step(Lane<Dim>& lane) {
  StepFrame frame;
  frame.kick = frame.last_dt = lane.brick.world->dt;
  lane.step.begin(frame);
  for (int c = 0; c < lane.brick.num_chunks(); ++c) lane.step.run_chunk(c);
}

template std::unique_ptr<Sample<2>> make_sample<2>(std::int64_t, VectorWidth, bool);
template std::unique_ptr<Sample<3>> make_sample<3>(std::int64_t, VectorWidth, bool);
template void step<2>(Lane<2>&);
template void step<3>(Lane<3>&);

}  // namespace barchan::micro
