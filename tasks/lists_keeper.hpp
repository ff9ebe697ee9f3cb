#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <barchan/core/brick/measures.hpp>
#include <barchan/tasks/rebuild_schedule.hpp>
#include <barchan/tasks/run_options.hpp>
#include <barchan/tasks/run_parts.hpp>
#include <barchan/tasks/skin_tuner.hpp>
#include <barchan/tasks/step_graph.hpp>

namespace barchan {

/// Makes lists anew, with which skin and in chunks of which size. When, the schedule decides, and
/// whoever demands it. No bit depends on any of it.
template <int Dim>
class ListsKeeper {
 public:
  /// All of them live longer but for the options.
  ListsKeeper(RunParts<Dim>& run, StepGraph<Dim>& graph, RebuildSchedule& schedule,
              const RunOptions& options);

  /// Since lists were made; of this rank's particles, and of walls. Local.
  [[nodiscard]] Travel travel() const;
  /// Of all ranks [m/s]. Collective.
  [[nodiscard]] double top_speed() const;
  /// See outrun_share.
  [[nodiscard]] double wall_outrun() const;

  /// That this rank wishes for [m]; 0: it does not.
  [[nodiscard]] double wished_skin(std::int64_t step);
  /// All ranks agreed on a skin [m]; 0: on none.
  void take_skin(double skin);
  void demand() { is_demanded_ = true; }  ///< lists before the next step
  [[nodiscard]] bool are_demanded(std::int64_t step) const {
    return is_demanded_ || (hooks_.rebuild_every > 0 && step % hooks_.rebuild_every == 0);
  }
  /// Collective.
  void renew(std::int64_t step);
  /// Walls stand where they do as lists are made.
  void note_walls();
  [[nodiscard]] const std::vector<Vec3>& walls_at_renewal() const { return walls_at_renewal_; }
  /// Lists as they were: walls stood there, and nobody asks for new ones.
  void recall(const std::vector<Vec3>& walls_at_renewal) {
    walls_at_renewal_ = walls_at_renewal;
    is_demanded_ = false;
  }

  [[nodiscard]] double seconds() const { return seconds_; }  ///< of renewals

 private:
  [[nodiscard]] double next_skin() const;
  void size_chunks(std::int64_t step);
  void note_work(std::int64_t step);

  RunParts<Dim>& run_;
  StepGraph<Dim>& graph_;
  RebuildSchedule& schedule_;
  TestHooks hooks_;
  std::optional<SkinTuner> tuner_;  ///< of rank 0
  double tuned_skin_;               ///< that all ranks agreed on [m]
  bool is_demanded_ = false;
  std::vector<Vec3> walls_at_renewal_;
  double chunk_seconds_ = 0.0;  ///< of chunks when they were last sized
  std::int64_t chunks_sized_at_ = 0;
  double seconds_ = 0.0;
};

extern template class ListsKeeper<2>;
extern template class ListsKeeper<3>;

}  // namespace barchan
