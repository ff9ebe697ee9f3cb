#include <barchan/tasks/stages.hpp>

namespace barchan {
namespace {

constexpr std::int64_t kStageCheck = 100;  // steps between looks at the kinetic ratio

}  // namespace

bool Stages::time_is_over(std::int64_t step) const {
  const double dt = model_.time.step;
  return static_cast<double>(step - begin_) * dt >= spec().max_time - 0.5 * dt;
}

bool Stages::may_end(std::int64_t step) const {
  const std::int64_t steps = step - begin_;
  return time_is_over(step) ||
         (spec().kinetic_ratio > 0.0 && steps > 0 && steps % kStageCheck == 0);
}

void Stages::save(CheckpointState& state) const {
  state.stage = current_;
  state.stage_begin = begin_;
}

void Stages::restore(const CheckpointState& state) {
  current_ = state.stage;
  begin_ = state.stage_begin;
}

}  // namespace barchan
