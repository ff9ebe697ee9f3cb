#include <barchan/tasks/run_parts.hpp>

#include <memory>

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

/// An unknown exchange is reported first, then cuts that do not fit.
template <int Dim>
LaneMap lanes_for(const RunOptions& options, const Communicator& ranks, const Model& model,
                  const World<Dim>& world) {
  check_exchange(options.exchange, ranks);
  const CutRoom room = room_of(world.grid, world.num_particles);
  CutRequest request{model.domain.cuts, ranks.size(), options.threads,
                     cut_scheme(options) == CutScheme::Returned, model.domain.place};
  if (!options.cuts.empty()) request.wish = parse_cuts(options.cuts);
  return {choose_cuts(request, room), room.is_periodic};
}

std::unique_ptr<Exchange> exchange_for(const RunOptions& options, const Communicator& communicator,
                                       const LaneMap& lanes) {
  return first_exchange(options, communicator, neighbours_of(lanes.ties(communicator.rank())));
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
      rebuild(strip) {}

template struct RunParts<2>;
template struct RunParts<3>;

}  // namespace barchan
