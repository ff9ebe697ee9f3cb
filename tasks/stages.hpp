#pragma once

#include <cstdint>

#include <barchan/core/checkpoint/state.hpp>
#include <barchan/core/model/model.hpp>
#include <barchan/tasks/run_parts.hpp>

namespace barchan {

/// Which stage a run is in, since when, and when it may be over.
class Stages {
 public:
  /// @param model  lives longer
  explicit Stages(const Model& model) : model_(model) {}

  [[nodiscard]] int current() const { return current_; }
  [[nodiscard]] const Stage& spec() const {
    return model_.stages[static_cast<std::size_t>(current_)];
  }
  [[nodiscard]] bool is_last() const {
    return static_cast<std::size_t>(current_) + 1 == model_.stages.size();
  }
  [[nodiscard]] bool begins_at(std::int64_t step) const { return step == begin_; }
  [[nodiscard]] bool time_is_over(std::int64_t step) const;
  /// Steps from `step` on have another length. Before the model has it.
  void count_from(std::int64_t step) { since_ = {time_in_it(step), step}; }
  /// The step before `step` was `dt` long.
  void count_short(std::int64_t step, double dt) { since_ = {time_in_it(step - 1) + dt, step}; }
  /// Whether somebody must look, before that step, whether the stage is over.
  [[nodiscard]] bool may_end(std::int64_t step) const;
  void enter_next(std::int64_t step) {
    ++current_;
    begin_ = step;
    since_ = {0.0, step};
  }

  void save(CheckpointState& state) const {
    state.stage = current_;
    state.stage_begin = begin_;
    state.stage_since = since_;
  }
  void restore(const CheckpointState& state) {
    current_ = state.stage;
    begin_ = state.stage_begin;
    since_ = state.last_dt > 0.0 ? state.stage_since : TimePoint{0.0, begin_};
  }

 private:
  [[nodiscard]] double time_in_it(std::int64_t step) const {
    return since_.at(step, model_.time.step);
  }

  const Model& model_;
  int current_ = 0;
  std::int64_t begin_ = 0;  ///< step
  TimePoint since_;         ///< of the time in this stage
};

/// Shows the walls of the present stage. @return whether one appeared, so that lists must be made
/// anew. Collective. Errors: AgreedError for a wall that appears where a particle is: it would
/// throw it out.
template <int Dim>
bool show_walls(RunParts<Dim>& run, const Stages& stages, std::int64_t step);

}  // namespace barchan
