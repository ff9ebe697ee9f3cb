#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include <barchan/core/links/bond_break.hpp>
#include <barchan/tasks/notes.hpp>
#include <barchan/tasks/particle_view.hpp>

namespace barchan {

/// Where a run stands.
struct RunProgress {
  std::int64_t step = 0;
  double time = 0.0;  ///< [s]
};

/// A checkpoint that is on the disk, or could not be written.
struct CheckpointEvent {
  std::int64_t step = 0;
  std::string folder;  ///< where it is; empty: it is not
  std::string error;   ///< what went wrong; empty: nothing
};

/// A callback of a caller. Ranks agree on whether some rank has one, and on how often it is due.
template <class... What>
struct Callback {
  std::function<void(What...)> call;  ///< empty: none on this rank
  bool is_wanted = false;             ///< some rank has one
  std::int64_t every = 0;             ///< steps; 0: it is not one of steps

  [[nodiscard]] bool is_due(std::int64_t step) const {
    return is_wanted && every > 0 && step % every == 0;
  }
};

/// What run() tells a caller of, on the thread that called it; the views of a step on all threads.
struct RunEvents {
  Callback<const ParticleView&> step;
  Callback<std::span<const ParticleView>> step_together;
  Callback<const RunProgress&> progress;
  Callback<const Note&> note;
  Callback<const CheckpointEvent&> checkpoint;
  Callback<std::span<const BondBreak>> breaks;

  /// Notes, checkpoints and breaks are told after every so many steps, and when run() returns.
  static constexpr std::int64_t kNewsEvery = 16;

  [[nodiscard]] bool has_news() const {
    return note.is_wanted || checkpoint.is_wanted || breaks.is_wanted;
  }
  /// Before this step.
  [[nodiscard]] bool is_visit_due(std::int64_t at) const {
    return step.is_due(at) || step_together.is_due(at);
  }
  [[nodiscard]] bool is_news_due(std::int64_t at) const {
    return has_news() && at % kNewsEvery == 0;
  }
  /// So many of the next steps, at most `most`, can be done before something is due.
  [[nodiscard]] std::int64_t steps_before_next(std::int64_t now, std::int64_t most) const;
};

}  // namespace barchan
