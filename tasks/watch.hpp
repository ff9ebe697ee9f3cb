#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <barchan/tasks/notes.hpp>
#include <barchan/tasks/rebuild_schedule.hpp>
#include <barchan/tasks/run_parts.hpp>
#include <barchan/tasks/step_graph.hpp>

namespace barchan {

/// How many particles a run has, on all ranks, and which have left.
struct Population {
  std::int64_t size = 0;
  LeftDomain left;
  /// On rank 0, before they are removed.
  std::function<void(std::span<const Departure>)> tell_departures;
};

/// Notices what goes wrong in a run with the checks of the rebuild schedule, at no message more.
/// Only a run that ends or a particle that goes costs messages of its own. Every rank comes to the
/// same verdict; but for see_overlap() and is_harmless() all is collective.
template <int Dim>
class Watch {
 public:
  /// All of them live longer.
  Watch(RunParts<Dim>& run, StepGraph<Dim>& graph, Population& population, Notes& notes)
      : run_(run), graph_(graph), population_(population), notes_(notes) {}

  /// Of a measurement; the next look takes it along.
  void see_overlap(double share) { overlap_ = std::max(overlap_, share); }
  /// What looks to come depend on.
  struct Memory {
    double overlap = 0.0;
    std::int64_t overlap_watched_at = 0;
  };
  [[nodiscard]] Memory memory() const { return {overlap_, overlap_watched_at_}; }
  void recall(const Memory& memory) {
    overlap_ = memory.overlap;
    overlap_watched_at_ = memory.overlap_watched_at;
    must_remove_ = false;
  }
  /// What this rank brings to a look: who is outside, and overlaps now and then.
  void look(std::int64_t step, CheckNumbers& mine);
  /// What it brings to every check.
  void count(CheckNumbers& mine) const;

  /// Whether there is nothing to judge.
  [[nodiscard]] bool is_harmless(const CheckNumbers& answer) const;
  /// Errors: AgreedError
  void judge(std::int64_t step, const CheckNumbers& answer);
  /// What is out of the domain, if the last verdict says so, goes with the rebuild that follows.
  /// @return whether something goes
  bool remove_outside(std::int64_t step);
  /// Plates have no thickness, and given velocities no limit. Errors: AgreedError
  void judge_plates(std::int64_t step) const;

 private:
  void judge_balance(std::int64_t step, const CheckNumbers& answer) const;
  void judge_overlap(std::int64_t step, double share);
  [[nodiscard]] std::vector<Departure> departures(std::int64_t step) const;

  RunParts<Dim>& run_;
  StepGraph<Dim>& graph_;
  Population& population_;
  Notes& notes_;
  double overlap_ = 0.0;                 ///< largest share seen since the last look
  std::int64_t overlap_watched_at_ = 0;  ///< step
  bool has_warned_ = false;              ///< of overlap
  bool must_remove_ = false;             ///< particles out of the domain
};

extern template class Watch<2>;
extern template class Watch<3>;

}  // namespace barchan
