#include <gtest/gtest.h>

#include <barchan/comm/base/tape.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/tasks/simulation.hpp>

namespace barchan {
namespace {

/// Particles that fall, collide and cross cuts, between walls.
Model falling(bool is_periodic) {
  Model m;
  m.dimension = 2;
  m.domain.hi = Vec3(8.0, 3.0, 0.0);
  m.domain.periodic[0] = is_periodic;
  m.gravity = Vec3(1.0, -9.81, 0.0);
  m.time.step = 2e-4;
  m.materials = {{"grain", 100.0}};
  m.contacts.num_materials = 1;
  ContactConstants c;
  c.kn = 1e4;
  c.kt = 4e3;
  c.mu = 0.5;
  c.cn.constant = 2.0;
  c.ct.constant = 1.0;
  m.contacts.constants = {c};
  m.stages = {Stage{}};
  const auto wall = [&m](Vec3 point, Vec3 normal) {
    WallSpec w;
    w.name = "wall";
    w.point = point;
    w.normal = normal;
    m.walls.push_back(w);
  };
  wall(Vec3(0, 0, 0), Vec3(0, 1, 0));
  if (!is_periodic) {
    wall(Vec3(0, 0, 0), Vec3(1, 0, 0));
    wall(Vec3(8, 0, 0), Vec3(-1, 0, 0));
  }
  return m;
}

ParticleSet lattice() {
  ParticleSet set;
  std::int64_t id = 1;
  for (int i = 0; i < 38; ++i) {
    for (int j = 0; j < 8; ++j) {
      ParticleData p;
      p.id = id++;
      p.radius = 0.08 + 0.002 * static_cast<double>(id % 7);
      p.density = 100.0;
      p.position = Vec3(0.2 + 0.2 * i, 0.15 + 0.2 * j, 0.0);
      p.velocity = Vec3(i < 19 ? 3.0 : -3.0, 0.0, 0.0);
      set.particles.push_back(p);
    }
  }
  return set;
}

struct Outcome {
  std::uint64_t digest = 0;
  std::int64_t contacts = 0, migrations = 0, rebuilds = 0;
  bool operator==(const Outcome&) const = default;
};

Outcome outcome_of(const Model& model, const RunOptions& options) {
  Simulation sim(model, lattice(), MPI_COMM_WORLD, options);
  sim.run(400);
  const std::int64_t contacts = sim.measure().contacts;
  return {sim.digest(), contacts, sim.timings().migrations, sim.timings().rebuilds};
}

class Replay : public testing::TestWithParam<const char*> {};

TEST_P(Replay, EndsAsTheRecordedRunWithoutAnyMessage) {
  for (const bool is_periodic : {false, true}) {
    const Model model = falling(is_periodic);
    RunOptions options;
    options.threads = 2;
    options.exchange = GetParam();
    options.tape = std::make_shared<Tape>();
    const Outcome recorded = outcome_of(model, options);

    options.tape->rewind();
    options.exchange = "replay";
    const Outcome replayed = outcome_of(model, options);

    EXPECT_EQ(recorded, replayed) << GetParam() << (is_periodic ? " periodic" : "");
    EXPECT_GT(recorded.rebuilds, 1);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Replay, testing::Values("put-flag", "isend", "auto", "sendrecv"),
                         [](const auto& param) {
                           std::string name = param.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(ReplayExchange, IsRefusedWithoutARecordedTape) {
  RunOptions options;
  options.exchange = "replay";

  EXPECT_THROW(Simulation(falling(false), lattice(), MPI_COMM_WORLD, options), InputError);

  options.exchange = "put-flag";
  options.tape = std::make_shared<Tape>();
  options.tape->rewind();
  EXPECT_THROW(Simulation(falling(false), lattice(), MPI_COMM_WORLD, options), InputError);
}

TEST(StepTimes, ExposeNoMoreThanIsInFlightAndFillTheLoop) {
  for (const Schedule schedule : {Schedule::Overlap, Schedule::Sequential}) {
    RunOptions options;
    options.threads = 1;
    options.schedule = schedule;
    Simulation sim(falling(false), lattice(), MPI_COMM_WORLD, options);
    sim.run(300);

    const Timings t = sim.timings();

    double sum = 0.0;
    for (const auto& [name, seconds] : t.phases) {
      EXPECT_GE(seconds, -1e-6) << name;
      sum += seconds;
    }
    EXPECT_NEAR(sum, t.loop_seconds, 0.001 * t.loop_seconds);
    EXPECT_LE(t.exposed_seconds, t.in_flight_seconds * 1.001 + 1e-6);
    EXPECT_EQ(t.exposed_seconds > 0.0, sim.communicator().size() > 1);
  }
}

/// Messages and tasks are held up for milliseconds, so that what anything else on the machine takes
/// from a run is small beside what communication takes.
TEST(StepTimes, AgreeWithWhatARunWithoutCommunicationSaves) {
  RunOptions options;
  options.threads = 1;
  options.exchange = "isend";
  options.hooks.max_delay_seconds = 8e-3;
  options.tape = std::make_shared<Tape>();
  const auto timings_of_run = [&options] {
    Simulation sim(falling(false), lattice(), MPI_COMM_WORLD, options);
    sim.run(250);
    return sim.timings();
  };
  const Timings recorded = timings_of_run();
  options.tape->rewind();
  options.exchange = "replay";

  const Timings replayed = timings_of_run();

  const double saved = recorded.loop_seconds - replayed.loop_seconds;
  if (recorded.exposed_seconds > 0.0) {
    EXPECT_GT(recorded.exposed_seconds, 0.3 * recorded.loop_seconds);
    EXPECT_NEAR(saved, recorded.exposed_seconds, 0.05 * recorded.loop_seconds);
    EXPECT_LT(replayed.exposed_seconds, 0.02 * recorded.loop_seconds);
  } else {
    EXPECT_EQ(recorded.communication.at("halo").exposed, 0.0);  // a lone rank
  }
  for (const auto& [name, kind] : recorded.communication)
    EXPECT_LE(kind.late, kind.exposed) << name;
}

}  // namespace
}  // namespace barchan
