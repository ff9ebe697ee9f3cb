#include <barchan/tasks/skin_tuner.hpp>

#include <cmath>

namespace barchan {
namespace {

constexpr double kStep = 0.8;
constexpr int kNarrowest = 4;
constexpr std::int64_t kTrialSteps = 400;
constexpr double kTrialSeconds = 0.1;
constexpr double kBetter = 0.985;  ///< of the cost before; less is noise
constexpr int kRest = 60;          ///< trials

}  // namespace

double SkinTuner::skin(int k) const {
  return widest_ * std::pow(kStep, k);
}

double SkinTuner::wish(std::int64_t steps, double seconds) {
  if (begin_step_ < 0) {
    begin_step_ = steps;
    begin_seconds_ = seconds;
  }
  const std::int64_t served = steps - begin_step_;
  if (served >= kTrialSteps && seconds - begin_seconds_ >= kTrialSeconds) {
    judge((seconds - begin_seconds_) / static_cast<double>(served));
    begin_step_ = steps;
    begin_seconds_ = seconds;
  }
  return skin(trial_);
}

void SkinTuner::judge(double cost) {
  if (rests_ > 0) {
    if (--rests_ == 0) best_cost_ = 0.0;  // the flow may be another one by now
    return;
  }
  const bool is_first = best_cost_ == 0.0;
  if (is_first || cost < kBetter * best_cost_) {
    best_ = trial_;
    best_cost_ = cost;
    turns_ = 0;
  } else {
    turn();
  }
  const auto is_there = [](int k) { return k >= 0 && k <= kNarrowest; };
  if (turns_ < 2 && !is_there(best_ + direction_)) turn();
  if (turns_ >= 2 || !is_there(best_ + direction_)) {
    trial_ = best_;
    turns_ = 0;
    rests_ = kRest;
    return;
  }
  trial_ = best_ + direction_;
}

void SkinTuner::turn() {
  direction_ = -direction_;
  ++turns_;
}

}  // namespace barchan
