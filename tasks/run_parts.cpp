#include <barchan/tasks/run_parts.hpp>

#include <algorithm>
#include <memory>

#include <barchan/comm/topology/strips.hpp>
#include <barchan/tasks/exchange_setup.hpp>
#include <barchan/tasks/strip_plan.hpp>

namespace barchan {
namespace {

template <int Dim>
World<Dim> world_for(const RunOptions& options, const Model& model, const WorldScale& scale,
                     int num_ranks) {
  World<Dim> world = make_world<Dim>(model, scale, vector_width(options.vector));
  if (options.search) world.search = *options.search;
  check_ranks(num_ranks, model, world.grid.num_slabs());
  return world;
}

template <int Dim>
std::unique_ptr<Exchange> exchange_for(const RunOptions& options, const Communicator& communicator,
                                       const Grid<Dim>& grid) {
  return first_exchange(
      options, communicator,
      strip_neighbours(communicator.rank(), communicator.size(), grid.is_periodic(0)));
}

/// As many as threads, where they fit.
template <int Dim>
int num_lanes(const RunOptions& options, const Grid<Dim>& grid, int num_ranks) {
  const int fit = max_strips(grid.num_slabs(), kMinSlabs) / num_ranks;
  return std::clamp(options.threads, 1, std::max(1, fit));
}

}  // namespace

template <int Dim>
RunParts<Dim>::RunParts(const Model& the_model, const Communicator& ranks,
                        const RunOptions& options, const WorldScale& the_scale)
    : model(the_model),
      communicator(ranks),
      scale(the_scale),
      world(world_for<Dim>(options, model, scale, ranks.size())),
      strip(world, ranks, exchange_for(options, ranks, world.grid),
            num_lanes(options, world.grid, ranks.size()), cut_scheme(options)),
      rebuild(strip) {}

template struct RunParts<2>;
template struct RunParts<3>;

}  // namespace barchan
