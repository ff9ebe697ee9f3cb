#include <barchan/tasks/run_parts.hpp>

#include <memory>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/tasks/cut_shape.hpp>
#include <barchan/tasks/exchange_setup.hpp>

namespace barchan {
namespace {

template <int Dim>
World<Dim> world_for(const RunOptions& options, const Model& model, const WorldScale& scale) {
  World<Dim> world = make_world<Dim>(model, scale, vector_width(options.vector));
  if (options.search) world.search = *options.search;
  return world;
}

int depth_of(const RunOptions& options, const Model& model) {
  const int depth = options.depth.value_or(model.exchange.depth);
  if (depth > 0 && cut_scheme(options) == CutScheme::Returned)
    throw InputError(model.exchange.place,
                     fmt::format("exchange 'return' with a depth of {}: its neighbour computes the "
                                 "forces of a cut and sends them back, so it cannot be late",
                                 depth),
                     "use another exchange, or a depth of 0");
  if (depth < 0 || depth > kMostDepth)
    throw InputError(model.exchange.place, fmt::format("a depth of {}", depth),
                     fmt::format("use one from 0 to {}", kMostDepth));
  return depth;
}

/// An unknown exchange is reported first, then cuts that do not fit.
template <int Dim>
LaneMap lanes_for(const RunOptions& options, const Communicator& ranks, const Model& model,
                  const World<Dim>& world) {
  check_exchange(options.exchange, ranks);
  const CutRoom room = room_of(world.grid, world.num_particles);
  CutRequest request{model.domain.cuts,   ranks.size(),
                     options.threads,     cut_scheme(options) == CutScheme::Returned,
                     model.domain.place,  depth_of(options, model),
                     model.exchange.place};
  if (!options.cuts.empty()) request.wish = parse_cuts(options.cuts);
  return {choose_cuts(request, room), room.is_periodic};
}

std::unique_ptr<Exchange> exchange_for(const RunOptions& options, const Communicator& communicator,
                                       const LaneMap& lanes) {
  return first_exchange(options, communicator, neighbours_of(lanes.ties(communicator.rank())),
                        lanes.shape().depth);
}

}  // namespace

template <int Dim>
RunParts<Dim>::RunParts(const Model& the_model, const Communicator& ranks,
                        const RunOptions& options, const WorldScale& the_scale)
    : model(the_model),
      communicator(ranks),
      scale(the_scale),
      world(world_for<Dim>(options, model, scale)),
      lanes(lanes_for(options, ranks, model, world)),
      strip(world, ranks, exchange_for(options, ranks, lanes), lanes, cut_scheme(options)),
      rebuild(strip) {
#ifdef NDEBUG
  if (options.hooks.compare_shadows) strip.keep_shadows_level();
#else
  strip.keep_shadows_level();
#endif
}

template struct RunParts<2>;
template struct RunParts<3>;

}  // namespace barchan
