#pragma once

#include <mpi.h>

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <barchan/tasks/simulation.hpp>

#include <support/temporary_folder.hpp>

#include "scenarios.hpp"

// What tests on several ranks share: who they are, a folder for all, and a run in words that must
// be equal.

namespace barchan::test {

inline int num_ranks() {
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return size;
}

inline bool is_root() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank == 0;
}

inline RunOptions with_threads(int threads, const std::string& exchange = "put-flag") {
  RunOptions options;
  options.threads = threads;
  options.exchange = exchange;
  return options;
}

/// A folder that all ranks see, gone after the test.
class SharedFolder {
 public:
  SharedFolder() {
    std::array<char, 64> name{};
    if (is_root()) {
      folder_.emplace(".");
      folder_->path().copy(name.data(), name.size() - 1);
    }
    MPI_Bcast(name.data(), static_cast<int>(name.size()), MPI_CHAR, 0, MPI_COMM_WORLD);
    path_ = name.data();
  }
  ~SharedFolder() { MPI_Barrier(MPI_COMM_WORLD); }
  SharedFolder(const SharedFolder&) = delete;
  SharedFolder& operator=(const SharedFolder&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::string at(std::int64_t step) const {
    return fmt::format("{}/step_{:09}", path_, step);
  }

 private:
  std::optional<TemporaryFolder> folder_;  ///< of the root
  std::string path_;
};

using Words = std::vector<std::uint64_t>;

inline Words words_of(Simulation& sim) {
  const Measures m = sim.measure();
  Words words{sim.digest(),
              static_cast<std::uint64_t>(sim.step()),
              static_cast<std::uint64_t>(sim.stage()),
              static_cast<std::uint64_t>(m.contacts),
              static_cast<std::uint64_t>(m.bonds),
              static_cast<std::uint64_t>(m.broken_bonds)};
  const auto add = [&](double value) { words.push_back(std::bit_cast<std::uint64_t>(value)); };
  for (const double value :
       {m.kinetic.value(), m.elastic.value(), m.gravitational.value(), m.max_overlap, m.max_speed,
        m.momentum[0].value(), m.momentum[1].value(), m.momentum[2].value()}) {
    add(value);
  }
  for (const WallState& w : sim.walls()) {
    for (int c = 0; c < 3; ++c) {
      add(w.force[c]);
      add(w.torque[c]);
      add(w.point[c]);
      add(w.velocity[c]);
    }
    add(w.work);
  }
  if (sim.model().heat.is_on) {
    for (const double value : {m.heat.value(), m.min_temperature, m.max_temperature}) add(value);
    for (const WallState& w : sim.walls()) add(w.heat_flow);
  }
  if (!sim.model().output.energy) return words;
  const EnergyBudget b = sim.energy_budget(m);
  for (const double value :
       {b.gravity_work, b.caller_work, b.contact_loss, b.dashpot_loss, b.sliding_loss,
        b.rolling_loss, b.bond_loss, b.damping_loss, b.departed, b.error})
    add(value);
  return words;
}

struct Course {
  Words middle, end;
};

/// Runs to the end, saving at a given step if any; words of the middle and of the end.
inline Course whole_run(const Scenario& s, MPI_Comm comm, const RunOptions& options,
                        std::int64_t middle, const std::string& folder) {
  Simulation sim(s.model, s.set, comm, options);
  if (!folder.empty()) sim.keep_checkpoints(folder, {});
  if (s.force) sim.apply_forces(s.force);
  sim.run(middle);
  Course run{words_of(sim), {}};
  if (!folder.empty()) sim.save_checkpoint();
  sim.run(s.num_steps - middle);
  EXPECT_TRUE(sim.finish_checkpoints());
  EXPECT_EQ(sim.take_checkpoint_warnings(), std::vector<std::string>{});
  run.end = words_of(sim);
  return run;
}

}  // namespace barchan::test
