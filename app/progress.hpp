#pragma once

#include <cstdint>
#include <string>

#include <barchan/core/base/clock.hpp>
#include <barchan/tasks/simulation.hpp>

namespace barchan::app {

/// Tells on stderr how far a run has come: on a terminal one line that changes a few times a
/// second, else a line every ten seconds. Rank 0 prints; times and hidden share are its own.
class Progress {
 public:
  /// @param file  kept up to date for `barchan watch`, and removed at the end; a quiet run, whose
  /// ranks must not meet for it, writes it when a result is due
  Progress(const Simulation& simulation, bool is_quiet, std::string file);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// How many steps to run until the next update() should be; the same on every rank. Collective.
  [[nodiscard]] std::int64_t most_steps();
  void update();
  void clear();  ///< leaves an empty line on a terminal

 private:
  void print(double now);
  void write(double now);
  [[nodiscard]] double seconds_left(double now) const;

  const Simulation& simulation_;
  std::string file_;
  double last_write_ = 0.0;
  bool is_silent_;    ///< all ranks alike
  bool is_terminal_;  ///< rank 0 knows
  double interval_;   ///< [s] between lines
  std::int64_t begin_ = now_ns();
  double last_seconds_ = 0.0, last_loop_ = 0.0;  ///< at the last line
  std::int64_t last_step_;
  bool has_line_ = false;
};

}  // namespace barchan::app
