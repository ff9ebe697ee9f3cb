// Courses of calls that are drawn at random, with states to go back to: the same on any ranks.
// BARCHAN_SOAK_COURSES=N draws N of them instead of a few.
#include <gtest/gtest.h>
#include <mpi.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <barchan/core/base/error.hpp>
#include <barchan/core/model/digest.hpp>

#include "coupling.hpp"
#include "law_scenarios.hpp"

namespace barchan::test {
namespace {

/// Draws calls; all ranks draw the same ones. What a call refuses, every rank is refused.
class Caller {
 public:
  Caller(Simulation& sim, const Scenario& scenario, unsigned seed)
      : sim_(sim), s_(scenario), random_(seed), dt_(scenario.model.time.step) {}

  void make_calls(int count) {
    for (int k = 0; k < count; ++k) {
      try {
        make_one(draw(15));
        log_.push_back(0);
        ++num_made_;
      } catch (const InputError&) {
        log_.push_back(1);
      }
      sim_.run(draw(8));
    }
  }
  [[nodiscard]] int num_made() const { return num_made_; }
  /// What was refused, and how often lists of links had which length.
  [[nodiscard]] const std::vector<std::uint64_t>& log() const { return log_; }

 private:
  [[nodiscard]] int draw(int most) {
    return static_cast<int>(random_() % static_cast<unsigned>(most));
  }
  [[nodiscard]] double share() { return 1e-3 * draw(1000); }
  [[nodiscard]] Vec3 vector(double size) {
    const double x = size * (share() - 0.5), y = size * (share() - 0.5), z = share() - 0.5;
    return {x, y, s_.model.dimension == 3 ? size * z : 0.0};
  }

  void make_one(int which) {
    switch (which) {
      case 0:
        return sim_.set_gravity(vector(30.0));
      case 1:
        return (void)sim_.advance_to(sim_.time() + 9.0 * share() * dt_);
      case 2:
        return sim_.set_time_step((0.3 + share()) * dt_);
      case 3:
        return load_all(vector(2.0));
      case 4:
        return sim_.clear_forces();
      case 5: {
        const auto ids = some_ids();  // before the values, of which there are as many
        return sim_.scatter(ParticleField::Velocity, ids, three_each());
      }
      case 6:
        return go_and_come();
      case 7:
        return change_contact();
      case 8:
        return move_wall();
      case 9:
        return count_links();
      case 11:
        return use_field();
      case 12:
        return load_in_steps();
      case 10:
        return sim_.save(states_[static_cast<std::size_t>(draw(2))]);
      default:
        return go_back(states_[static_cast<std::size_t>(draw(2))]);
    }
  }

  void load_all(const Vec3& force) {
    const auto views = sim_.owned();
    const auto loads = sim_.loads();
    for (std::size_t b = 0; b < views.size(); ++b) {
      for (std::size_t i = 0; i < views[b].size(); ++i)
        loads[b].set(i, (1.0 + static_cast<double>(views[b].ids()[i] % 3)) * force);
    }
  }

  /// Adds to a field of the caller's own what tells particles and times apart.
  void use_field() {
    const std::string name = draw(2) == 0 ? "a" : "b";
    sim_.add_field(name, name == "a" ? 1 : 3);
    for (const ParticleView& view : sim_.owned()) {
      const auto values = view.field(name);
      for (std::size_t i = 0; i < values.size(); ++i)
        values[i][values.width() - 1] += static_cast<double>(view.ids()[i]) * sim_.time();
    }
  }
  void load_in_steps() {
    if (draw(3) == 0) return sim_.on_step(1, {});
    sim_.on_step(1 + draw(6), [](const ParticleView& view) {
      const auto v = view.velocities();
      const LoadView loads = view.loads();
      for (std::size_t i = 0; i < v.size(); ++i) loads.set(i, drag(v[i][0], v[i][1], 0.0));
    });
  }

  std::vector<std::int64_t> some_ids() {
    ids_.clear();
    for (int k = 1 + draw(3); k > 0; --k) ids_.push_back(1 + draw(static_cast<int>(num())));
    std::sort(ids_.begin(), ids_.end());
    ids_.erase(std::unique(ids_.begin(), ids_.end()), ids_.end());
    return ids_;
  }
  std::vector<double> three_each() {
    std::vector<double> values;
    for (std::size_t k = 0; k < ids_.size(); ++k) {
      const Vec3 v = vector(2.0);
      values.insert(values.end(), {v[0], v[1], v[2]});
    }
    return values;
  }
  [[nodiscard]] std::size_t num() const { return s_.set.particles.size(); }

  /// Some that are there go; one that was there at the start comes back, where there is room.
  void go_and_come() {
    sim_.remove(some_ids());
    ParticleData back = s_.set.particles[static_cast<std::size_t>(draw(static_cast<int>(num())))];
    back.velocity = vector(1.0);
    sim_.add(std::span(&back, 1));
  }

  void change_contact() {
    const std::string& name = s_.model.materials[0].name;
    ContactConstants pair = s_.model.contacts.constants[0];
    pair.mu *= 2.0 * share();
    pair.kn *= 0.5 + share();
    sim_.set_contact(name, name, pair);
  }

  void move_wall() {
    if (s_.model.walls.empty()) return;
    const auto w = static_cast<std::size_t>(draw(static_cast<int>(s_.model.walls.size())));
    WallControl wall = sim_.wall(s_.model.walls[w].name);
    if (draw(2) == 0) return wall.set_pose(wall.state().point + vector(0.01));
    if (s_.model.walls[w].is_loaded) return wall.set_load(500.0 * (share() - 0.5));
    wall.set_velocity(vector(1.0));
  }

  void count_links() {
    std::int64_t counts[3] = {};
    for (const LinkKind kind : {LinkKind::Contacts, LinkKind::WallContacts, LinkKind::Bonds})
      counts[static_cast<int>(kind)] = static_cast<std::int64_t>(sim_.links(kind).size());
    sim_.communicator().allreduce_sum(std::span<std::int64_t>(counts));
    for (const std::int64_t n : counts) log_.push_back(static_cast<std::uint64_t>(n));
  }

  void go_back(const State& state) {
    if (!state.is_empty()) sim_.load(state);
  }

  Simulation& sim_;
  const Scenario& s_;
  std::mt19937 random_;
  double dt_;
  std::vector<std::int64_t> ids_;
  State states_[2];
  std::vector<std::uint64_t> log_;
  int num_made_ = 0;
};

/// Of all fields of the caller's own, the same on every rank. Collective.
std::uint64_t hash_of_fields(Simulation& sim) {
  std::uint64_t hash = 0;
  for (const CallerField& field : sim.fields()) {
    const Gathered all = sim.gather(field.name);
    hash = 31 * hash + hash_of_bytes(std::as_bytes(std::span(all.values)));
  }
  sim.communicator().bcast(std::as_writable_bytes(std::span(&hash, 1)));
  return hash;
}

Words words_of_course(const Scenario& s, MPI_Comm comm, int threads, unsigned seed) {
  Simulation sim(s.model, s.set, comm, with_threads(threads));
  Caller caller(sim, s, seed);
  Words words;
  try {
    caller.make_calls(25);
    words = words_of(sim);
  } catch (const AgreedError& e) {  // such as an overlap beyond the limit
    words = {sim.digest(), static_cast<std::uint64_t>(sim.step())};
  }
  words.push_back(hash_of_fields(sim));
  EXPECT_GT(caller.num_made(), 8);  // some are refused, and some end the run
  words.insert(words.end(), caller.log().begin(), caller.log().end());
  return words;
}

TEST(CallsSoak, CoursesOfRandomCallsAreTheSameOnAnyRanks) {
  const char* wish = std::getenv("BARCHAN_SOAK_COURSES");
  const int num_courses = wish == nullptr ? 2 : std::atoi(wish);
  const Scenario scenarios[] = {breaking_plate(2), plates_at_borders(), rolling_column(),
                                moving_walls(), with_heat(attracting_gas(true), 200.0)};
  for (int course = 0; course < num_courses; ++course) {
    const Scenario& s = scenarios[(course + num_ranks()) % 5];
    const auto seed = static_cast<unsigned>(course + num_ranks());
    SCOPED_TRACE(s.name + ", course " + std::to_string(seed));
    const Words expected = words_of_course(s, MPI_COMM_SELF, 1, seed);
    EXPECT_EQ(words_of_course(s, MPI_COMM_WORLD, 1 + course % 2, seed), expected);
  }
}

}  // namespace
}  // namespace barchan::test
