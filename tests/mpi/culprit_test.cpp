// Who is named when a run goes wrong: the same particle, in the same words, wherever the cuts are.
#include <gtest/gtest.h>
#include <mpi.h>

#include <limits>
#include <string>

#include <fmt/format.h>

#include <barchan/comm/exchanges/make_exchange.hpp>
#include <barchan/core/base/error.hpp>

#include "running.hpp"
#include "scenarios.hpp"

namespace barchan::test {
namespace {

/// What a run that goes wrong says. @return empty: it went on
template <class Error, class Run>
std::string error_of(Run&& run) {
  try {
    run();
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

void push(Simulation& sim, std::int64_t id, double force) {
  sim.apply_forces(
      [&](const OwnedParticle& p) { return Vec3(p.id == id ? force : 0.0, 0.0, 0.0); });
}

/// One particle is pushed in one step.
template <class Error>
std::string error_after_push(const Scenario& s, MPI_Comm comm, const RunOptions& options,
                             std::int64_t id, double force) {
  Simulation sim(s.model, s.set, comm, options);
  sim.run(100);
  push(sim, id, force);
  return error_of<Error>([&] {
    sim.run(1);
    sim.clear_forces();
    sim.run(100);
  });
}

/// The text of rank 0, on every rank.
std::string from_root(const std::string& text) {
  return Communicator::world().bcast(text);
}

TEST(Culprit, OneThatOutranTheSkinIsNamedAlikeOnAnyNumberOfRanksAndThreads) {
  const Scenario s = soil_with_ring_and_plate();
  int told = 0, way = 0;
  for (std::int64_t id = 1; id <= 161; id += 20) {
    const auto error = [&](MPI_Comm comm, const RunOptions& options) {
      return error_after_push<AgreedError>(s, comm, options, id, 6e4);
    };
    const std::string expected = from_root(is_root() ? error(MPI_COMM_SELF, with_threads(1)) : "");
    const auto exchange = exchange_names()[static_cast<std::size_t>(way) % exchange_names().size()];
    const int threads = ++way % 3 + 1;

    const std::string got = error(MPI_COMM_WORLD, with_threads(threads, exchange));

    EXPECT_EQ(got, expected) << num_ranks() << " ranks of " << threads << " threads, " << exchange;
    if (got.find("touching particle ") != std::string::npos) ++told;
  }
  EXPECT_GT(told, 0);
}

/// Disks of one size that fall side by side overlap the floor alike: the lowest number is named.
TEST(Culprit, OfEqualOverlapsTheSameIsNamedOnAnyNumberOfRanksAndThreads) {
  Scenario s = moving_walls();
  s.model.limits = {0.01, 0.02};
  s.set.particles.resize(36);
  for (std::size_t p = 0; p < s.set.particles.size(); ++p) {
    ParticleData& particle = s.set.particles[p];
    particle.id = static_cast<std::int64_t>(s.set.particles.size() - p);
    particle.radius = 0.04;
    particle.position = Vec3(0.2 + 0.1 * static_cast<double>(p), 0.06, 0.0);
    particle.velocity = Vec3(0.0, -1.0, 0.0);
  }
  const auto error = [&](MPI_Comm comm, int threads) -> std::string {
    Simulation sim(s.model, s.set, comm, with_threads(threads));
    return error_of<AgreedError>([&] {
      for (int piece = 0; piece < 100; ++piece) {
        sim.run(5);
        (void)sim.measure();
      }
    });
  };
  const std::string expected = from_root(is_root() ? error(MPI_COMM_SELF, 1) : "");
  EXPECT_NE(expected.find("between particle 1 at"), std::string::npos) << expected;
  for (const int threads : {1, 2}) EXPECT_EQ(error(MPI_COMM_WORLD, threads), expected);
}

/// Every rank by itself: one that knows alone would leave the others waiting.
TEST(Culprit, OneThatGoesWildIsNamedInThatStepAlikeOnAnyNumberOfThreads) {
  const Scenario s = soil_with_ring_and_plate();
  for (const double force : {1e9, std::numeric_limits<double>::quiet_NaN()}) {
    for (const std::int64_t id : {5, 50, 100, 150}) {
      const auto error = [&](int threads) {
        return error_after_push<StepError>(s, MPI_COMM_SELF, with_threads(threads), id, force);
      };
      const std::string expected = error(1);
      EXPECT_NE(expected.find(fmt::format("in step 100 particle {} at (", id)), std::string::npos)
          << expected;
      EXPECT_NE(expected.find("touching "), std::string::npos) << expected;
      for (const int threads : {2, 3, 4}) EXPECT_EQ(error(threads), expected);
    }
  }
}

/// Two pairs of disks overlap far apart, one with more force, the other by a larger share. What a
/// lane has near it depends on the cuts.
TEST(Culprit, MoreForceThanSumsCanHoldIsToldAlikeOnAnyNumberOfThreads) {
  Scenario s = moving_walls();
  s.model.limits = {1e-4, 1e-3};
  s.set.particles.resize(4);
  for (std::size_t p = 0; p < 4; ++p) {
    ParticleData& particle = s.set.particles[p];
    particle.id = static_cast<std::int64_t>(p) + 1;
    particle.radius = 0.04;
    particle.velocity = Vec3::Zero();
    particle.position = Vec3(p < 2 ? 0.5 : 3.0, 0.6, 0.0);
    particle.position.x() += p % 2 == 0 ? 0.0 : 0.066;
  }
  s.set.particles[1].radius = 0.01;  // a larger share of the smaller radius, but less force
  s.set.particles[1].position.x() = 0.5455;
  const auto error = [&](int threads) {
    return error_of<StepError>([&] {
      Simulation sim(s.model, s.set, MPI_COMM_SELF, with_threads(threads));
      sim.run(20);
    });
  };
  const std::string expected = error(1);
  EXPECT_NE(expected.find("the contacts of one particle press with"), std::string::npos)
      << expected;
  for (const int threads : {2, 3}) EXPECT_EQ(error(threads), expected);
}

/// Where walls stand, lanes go on by themselves for some steps: the others may be ahead of the one
/// that stops.
TEST(Culprit, OneThatGoesWildInALaneThatIsBehindIsNamedInThatStep) {
  const Scenario s = column_collapse();
  int in_a_later_step = 0;
  for (const double force : {3e2, 1e3, 3e3, 1e4, 3e4, 1e5}) {
    for (const std::int64_t id : {3, 40}) {
      const auto error = [&](int threads) -> std::string {
        RunOptions options = with_threads(threads);
        options.hooks.max_delay_seconds = threads == 1 ? 0.0 : 1e-4;
        Simulation sim(s.model, s.set, MPI_COMM_SELF, options);
        sim.run(100);
        push(sim, id, force);
        return error_of<RunError>([&] { sim.run(200); });
      };
      const std::string expected = error(1);
      for (const int threads : {2, 3, 4}) EXPECT_EQ(error(threads), expected);
      if (expected.find("in step ") == 0 && expected.find("in step 100") != 0) ++in_a_later_step;
    }
  }
  EXPECT_GT(in_a_later_step, 0);
}

}  // namespace
}  // namespace barchan::test
