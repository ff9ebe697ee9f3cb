#pragma once

#include <cstdint>
#include <functional>

#include <barchan/core/brick/measures.hpp>
#include <barchan/tasks/run_parts.hpp>
#include <barchan/tasks/simulation.hpp>
#include <barchan/tasks/step_clock.hpp>

namespace barchan {

// What callers see of a simulation between steps, and do to it; see Simulation.

template <int Dim>
void for_each_owned(const Strip<Dim>& strip,
                    const std::function<void(const OwnedParticle&)>& visit);
/// Collective.
template <int Dim>
void for_each_bond(Strip<Dim>& strip, const BondVisitor& visit);
template <int Dim>
void apply_forces(Strip<Dim>& strip, const std::function<Vec3(const OwnedParticle&)>& force);
/// Over all ranks; sets force, torque and work of the walls. Collective.
template <int Dim>
[[nodiscard]] Measures measure(RunParts<Dim>& run);
/// Of all ranks. Collective.
template <int Dim>
[[nodiscard]] std::uint64_t digest(const Strip<Dim>& strip);

/// Seconds of the time loop that nobody but the engine knows.
struct LoopSeconds {
  std::int64_t steps = 0;
  double loop = 0.0, rebuilds = 0.0, checkpoints = 0.0;
  double reductions = 0.0;  ///< waits for sums over all ranks
};
template <int Dim>
[[nodiscard]] Timings timings_of(const RunParts<Dim>& run, const StepTimes& steps,
                                 const LoopSeconds& loop);

}  // namespace barchan
