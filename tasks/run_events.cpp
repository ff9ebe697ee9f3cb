#include <barchan/tasks/run_events.hpp>

#include <algorithm>

namespace barchan {

std::int64_t RunEvents::steps_before_next(std::int64_t now, std::int64_t most) const {
  const auto limit = [&](bool is_wanted, std::int64_t every) {
    if (is_wanted && every > 0) most = std::min(most, every - now % every);
  };
  limit(step.is_wanted, step.every);
  limit(step_together.is_wanted, step_together.every);
  limit(progress.is_wanted, progress.every);
  limit(has_news(), kNewsEvery);
  return most;
}

}  // namespace barchan
