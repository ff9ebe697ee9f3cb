#pragma once

#include <barchan/comm/base/communicator.hpp>
#include <barchan/core/brick/world.hpp>
#include <barchan/core/model/model.hpp>
#include <barchan/tasks/lane_map.hpp>
#include <barchan/tasks/run_options.hpp>
#include <barchan/tasks/strip.hpp>
#include <barchan/tasks/strip_rebuild.hpp>
#include <barchan/tasks/world_setup.hpp>

namespace barchan {

/// What a run is made of: its input, its ranks, what all lanes share, and the strip of this rank.
template <int Dim>
struct RunParts {
  /// Without particles. The model and the communicator live longer. Collective. Errors: InputError:
  /// cuts that do not fit, unknown exchange or vector width
  RunParts(const Model& model, const Communicator& communicator, const RunOptions& options,
           const WorldScale& scale);
  RunParts(const RunParts&) = delete;
  RunParts& operator=(const RunParts&) = delete;

  const Model& model;
  const Communicator& communicator;
  WorldScale scale;
  World<Dim> world;
  LaneMap lanes;
  Strip<Dim> strip;
  StripRebuild<Dim> rebuild;
};

}  // namespace barchan
