// What the time loop does for shadows, beside what Strip and StripRebuild do.
#include <algorithm>

#include <barchan/comm/base/tape.hpp>
#include <barchan/tasks/engine.hpp>

namespace barchan {

/// Decisions may be as late as halos. When particles are taken out is part of the state.
template <int Dim>
int Simulation::EngineOf<Dim>::lag_of(const RunParts<Dim>& run) {
  const int depth = run.lanes.shape().depth;
  if (depth == 0 || run.model.domain.outside == OutsidePolicy::Delete) return RebuildSchedule::kLag;
  return static_cast<int>(std::min<std::int64_t>(2 * (depth + 1), kEventSteps));
}

/// Shadows have callers' forces as they were when lists were made.
template <int Dim>
void Simulation::EngineOf<Dim>::tell_shadows_forces() {
  if (parts_.lanes.shape().depth == 0) return;
  std::int64_t has_some = 0;
  for (const Lane<Dim>& lane : parts_.strip.lanes())
    has_some += lane.brick.store.external.empty() ? 0 : 1;
  taped_sum(communicator_, std::span(&has_some, 1));
  if (has_some > 0 || had_forces_) lists_.demand();
  had_forces_ = has_some > 0;
}

template int Simulation::EngineOf<2>::lag_of(const RunParts<2>&);
template int Simulation::EngineOf<3>::lag_of(const RunParts<3>&);
template void Simulation::EngineOf<2>::tell_shadows_forces();
template void Simulation::EngineOf<3>::tell_shadows_forces();

}  // namespace barchan
