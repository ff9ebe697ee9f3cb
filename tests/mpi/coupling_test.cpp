// What other solvers call between steps: views, loads, gravity, walls.
#include <gtest/gtest.h>
#include <mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <barchan/core/base/error.hpp>

#include "coupling.hpp"

namespace barchan::test {
namespace {

Words course_by_callback(const Scenario& s, MPI_Comm comm, int threads) {
  Simulation sim(s.model, s.set, comm, with_threads(threads));
  for (int k = 0; k < 40; ++k) {
    sim.apply_forces(
        [](const OwnedParticle& p) { return drag(p.velocity[0], p.velocity[1], p.velocity[2]); });
    sim.run(4);
  }
  return words_of(sim);
}

Words course_by_views(const Scenario& s, MPI_Comm comm, int threads) {
  Simulation sim(s.model, s.set, comm, with_threads(threads));
  const int dim = s.model.dimension;
  for (int k = 0; k < 40; ++k) {
    const auto views = sim.owned();
    const auto loads = sim.loads();
    for (std::size_t b = 0; b < views.size(); ++b) {
      const auto v = views[b].velocities();
      for (std::size_t i = 0; i < v.size(); ++i)
        loads[b].set(i, drag(v[i][0], v[i][1], dim == 3 ? v[i][2] : 0.0));
    }
    sim.run(4);
  }
  return words_of(sim);
}

/// @param is_reversed  against the order of rows
Words course_by_ids(const Scenario& s, MPI_Comm comm, int threads, bool is_reversed) {
  Simulation sim(s.model, s.set, comm, with_threads(threads));
  for (int k = 0; k < 40; ++k) {
    std::vector<std::pair<std::int64_t, Vec3>> mine;
    sim.for_each_owned([&](const OwnedParticle& p) {
      mine.emplace_back(p.id, drag(p.velocity[0], p.velocity[1], p.velocity[2]));
    });
    if (is_reversed) std::reverse(mine.begin(), mine.end());
    std::vector<std::int64_t> ids;
    std::vector<double> forces;
    for (const auto& [id, f] : mine) {
      ids.push_back(id);
      forces.insert(forces.end(), {f[0], f[1], f[2]});
    }
    const std::array<double, 3> beside{1e300, 1e300, 1e300};
    sim.set_loads({ids, forces, std::span(beside).first(0)});  // empty, at no null pointer
    sim.run(4);
  }
  return words_of(sim);
}

TEST(Coupling, LoadsActAlikeHoweverTheyAreGiven) {
  for (const int dimension : {2, 3}) {
    const Scenario s = dragged(dimension);
    const Words expected = course_by_callback(s, MPI_COMM_SELF, 1);

    for (const int threads : {1, 2}) {
      EXPECT_EQ(course_by_views(s, MPI_COMM_WORLD, threads), expected);
      EXPECT_EQ(course_by_ids(s, MPI_COMM_WORLD, threads, threads == 2), expected);
    }
  }
}

TEST(Coupling, AViewShowsWhatTheCallbackShows) {
  for (const int dimension : {2, 3}) {
    const Scenario s = dragged(dimension);
    Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(2));
    sim.run(37);
    std::vector<OwnedParticle> expected;
    sim.for_each_owned([&](const OwnedParticle& p) { expected.push_back(p); });
    std::size_t at = 0;
    for (const ParticleView& view : sim.owned()) {
      for (std::size_t i = 0; i < view.size(); ++i, ++at) {
        const OwnedParticle& p = expected.at(at);
        EXPECT_EQ(view.ids()[i], p.id);
        EXPECT_EQ(view.mass(i), p.mass);
        EXPECT_EQ(*view.radii()[i], p.radius);
        EXPECT_EQ(view.types()[i], p.type);
        EXPECT_EQ(view.densities()[i], p.density);
        EXPECT_EQ(view.angular_velocity(i), p.omega);
        for (int c = 0; c < dimension; ++c) {
          EXPECT_EQ(view.positions()[i][c], p.position[c]);
          EXPECT_EQ(view.velocities()[i][c], p.velocity[c]);
        }
      }
    }
    EXPECT_EQ(at, expected.size());
  }
}

/// A lone particle far from everything: I·dω/dt = T, and the first kick is half.
TEST(Coupling, ATorqueTurnsAsRigidBodiesDo) {
  for (const int dimension : {2, 3}) {
    Scenario s = two_particles(false);
    s.model = plain_model(dimension, 4.0, 1.0);
    s.set.particles.resize(1);
    s.set.particles[0].velocity = Vec3::Zero();
    if (dimension == 3) s.set.particles[0].position[2] = 0.5;
    Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
    const double r = s.set.particles[0].radius;
    double mass = 0.0;
    for (const ParticleView& view : sim.owned()) {
      if (view.size() == 0) continue;
      mass = view.mass(0);
      const double torque[] = {0.0, 0.0, 3e-4}, none[] = {0.0, 0.0, 0.0};
      sim.set_loads({view.ids(), none, torque});
    }
    sim.run(50);
    const double inertia = (dimension == 2 ? 0.5 : 0.4) * mass * r * r;
    for (const ParticleView& view : sim.owned()) {
      if (view.size() == 0) continue;
      const double expected = 3e-4 / inertia * 49.5 * s.model.time.step;
      EXPECT_NEAR(view.angular_velocity(0)[2], expected, 1e-12 * expected);
    }
  }
}

TEST(Coupling, AViewEndsWhenRowsMove) {
  const Scenario s = dragged(2);
  auto sim = std::make_unique<Simulation>(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  const ParticleView first = sim->owned()[0];
  const LoadView loads = sim->loads()[0];
  const std::uint64_t generation = sim->generation();
  while (sim->generation() == generation) {
    (void)first.positions();
    sim->run(1);
  }
  expect_words(words_thrown<StaleView>([&] { (void)first.positions(); }), "after rows had moved");
  expect_words(words_thrown<StaleView>([&] { (void)loads.set(0, Vec3::Zero()); }), "loads");
  const LoadView fresh = sim->loads()[0];
  sim->clear_forces();
  expect_words(words_thrown<StaleView>([&] { (void)fresh.forces(); }), "take a new one");
  const ParticleView last = sim->owned()[0];
  Simulation moved = std::move(*sim);
  (void)last.positions();  // it is the same simulation
  moved = Simulation(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  expect_words(words_thrown<StaleView>([&] { (void)last.ids(); }), "was gone");
}

TEST(Coupling, GathersInOrderOfIdsAndScattersBack) {
  const Scenario s = dragged(3);
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(2)),
      mirror(s.model, s.set, MPI_COMM_SELF, with_threads(1));
  sim.run(30);
  mirror.run(30);
  std::vector<std::int64_t> ids;
  std::vector<double> velocities, forces;
  mirror.for_each_owned([&](const OwnedParticle& p) {
    ids.push_back(p.id);
    for (int c = 0; c < 3; ++c) {
      velocities.push_back(-0.5 * p.velocity[c]);
      forces.push_back(0.1 * p.velocity[c]);
    }
  });
  for (Simulation* each : {&sim, &mirror}) {
    each->scatter(ParticleField::Velocity, ids, velocities);
    each->scatter(ParticleField::Force, ids, forces);
    each->scatter(ParticleField::Torque, ids, std::vector<double>(forces.size(), 1e-3));
    each->run(50);
  }
  EXPECT_EQ(sim.digest(), mirror.digest());
  for (const auto field :
       {ParticleField::Position, ParticleField::AngularVelocity, ParticleField::Force,
        ParticleField::Torque, ParticleField::Mass, ParticleField::Type}) {
    const Gathered mine = sim.gather(field), all = mirror.gather(field);
    EXPECT_EQ(mine.values, is_root() ? all.values : std::vector<double>{});
    EXPECT_TRUE(std::is_sorted(mine.ids.begin(), mine.ids.end()));
  }
}

TEST(Coupling, GravityAndWallsMayChangeInTheCourse) {
  Scenario s = moving_walls();
  s.model.walls[1].name = "lid";
  expect_same_on_any_ranks(s, [](Simulation& sim) {
    sim.run(50);
    sim.set_gravity({9.81, 0.0, 0.0});
    sim.wall("lid").set_velocity({-3.0, 0.0, 0.0});
    sim.run(50);
    EXPECT_EQ(sim.wall("lid").state().velocity[0], -3.0);
    sim.set_gravity({0.0, 30.0, 0.0});
    sim.wall("lid").set_velocity({0.0, 0.0, 0.0});
    sim.run(50);
  });
}

TEST(Coupling, TheLoadOfAPlateMayChangeInTheCourse) {
  Scenario s = plates_at_borders();
  s.model.walls.at(s.model.walls.size() - 3).name = "piston";
  ASSERT_TRUE(s.model.walls.at(s.model.walls.size() - 3).is_loaded);
  expect_same_on_any_ranks(s, [&](Simulation& sim) {
    sim.run(60);
    sim.wall("piston").set_load(-900.0);
    sim.run(60);
  });
}

TEST(Coupling, RefusesWrongCallsInWords) {
  Scenario s = rough_bed();
  add_wall(s.model, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0});
  s.model.walls.back().name = "floor";
  Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  const std::vector<std::int64_t> unknown{1000000};
  const std::vector<double> three(3, 0.0), two(2, 0.0),
      nan(3, std::numeric_limits<double>::quiet_NaN());
  const auto wrong_loads = [&](const Loads& loads) {
    return words_thrown<std::invalid_argument>([&] { sim.set_loads(loads); });
  };
  expect_words(wrong_loads({unknown, three, {}}), "particle 1000000 is not on rank");
  expect_words(wrong_loads({unknown, two, {}}), "2 numbers of forces for 1 particles");
  expect_words(wrong_loads({unknown, nan, {}}), "not finite");
  expect_words(wrong_loads({unknown, three, two}), "numbers of torques");
  const auto wrong_scatter = [&](ParticleField field, const std::vector<std::int64_t>& ids,
                                 const std::vector<double>& values) {
    return words_thrown<InputError>([&] { sim.scatter(field, ids, values); });
  };
  using F = ParticleField;
  expect_words(wrong_scatter(F::Force, unknown, three), "there is no particle 1000000");
  expect_words(wrong_scatter(F::Force, unknown, two), "three each");
  expect_words(wrong_scatter(F::Force, {4, 4}, {1, 2, 3, 4, 5, 6}), "particle 4 is named twice");
  expect_words(wrong_scatter(F::Radius, unknown, three), "not to be set");
  const auto fixed = std::find_if(s.set.particles.begin(), s.set.particles.end(),
                                  [](const ParticleData& p) { return p.fixed; });
  expect_words(wrong_scatter(F::Velocity, {fixed->id}, three), "is fixed");
  if (num_ranks() > 1) {
    const std::vector<double> other(3, is_root() ? 1.0 : 2.0);
    expect_words(wrong_scatter(F::Force, unknown, other), "ranks give different lists");
    expect_words(words_thrown<InputError>([&] {
                   sim.set_gravity({other[0], 0.0, 0.0});
                 }),
                 "ranks give different values");
  }
  expect_words(words_thrown<InputError>([&] { sim.set_gravity({0.0, 0.0, 1.0}); }), "plane");
  expect_words(words_thrown<std::invalid_argument>([&] { (void)sim.wall("lid"); }), "'floor'");
  expect_words(words_thrown<InputError>([&] { sim.wall("floor").set_load(1.0); }), "not loaded");
  expect_words(words_thrown<std::logic_error>([&] { sim.load(State()); }), "empty");
  Simulation twin(s.model, s.set, MPI_COMM_WORLD, with_threads(1));
  const State of_twin = twin.save();
  expect_words(words_thrown<std::logic_error>([&] { sim.load(of_twin); }), "another simulation");
  EXPECT_EQ(sim.run(5), 5);
}

}  // namespace
}  // namespace barchan::test
