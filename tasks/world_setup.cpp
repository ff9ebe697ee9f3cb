#include <barchan/tasks/world_setup.hpp>

#include <barchan/core/model/contact_range.hpp>
#include <barchan/tasks/forecast.hpp>
#include <barchan/tasks/strip_plan.hpp>

namespace barchan {

WorldScale scale_of(const Model& model, const ParticleSet& particles) {
  const double skin = model.search.skin.value_or(default_skin(model, particles));
  return {skin,
          search_reach(model, particles, skin),
          static_cast<std::int64_t>(particles.particles.size()),
          !particles.bonds.empty(),
          force_grain(model, particles),
          heat_grain(model, particles),
          0};
}

template <int Dim>
World<Dim> make_world(const Model& model, const WorldScale& scale, VectorWidth width) {
  World<Dim> world;
  world.skin = scale.skin;
  world.range = contact_range_within(model.contacts, scale.reach - scale.skin);
  world.dt = world.last_dt = model.time.step;
  world.accounts = model.output.energy;
  world.search = model.search.kind;
  world.num_particles = scale.num_particles;
  world.num_carried = scale.num_carried;
  world.grid = Grid<Dim>(model.domain, scale.reach);
  world.laws = LawTable(model.contacts);
  world.grain = scale.grain;
  world.heat = HeatTable(model, scale.heat_grain);
  world.kernels = make_kernels(Dim, width, world.laws, scale.has_bonds, world.grid.box());
  world.bond_laws = model.bond_laws;
  world.set_walls(model.walls);
  return world;
}

template World<2> make_world(const Model&, const WorldScale&, VectorWidth);
template World<3> make_world(const Model&, const WorldScale&, VectorWidth);

}  // namespace barchan
