#include <barchan/tasks/world_setup.hpp>

namespace barchan {

template <int Dim>
void set_up(World<Dim>& world, const Model& model, const WorldScale& scale, VectorWidth width) {
  world.skin = scale.skin;
  world.dt = model.time.step;
  world.search = model.search.kind;
  world.num_particles = scale.num_particles;
  world.grid = Grid<Dim>(model.domain, scale.reach, scale.num_particles);
  world.laws = LawTable(model.contacts);
  world.grain = scale.grain;
  world.kernels = make_kernels(Dim, width, world.laws, scale.has_bonds, world.grid.box());
  world.bond_laws = model.bond_laws;
  world.set_walls(model.walls);
}

template void set_up(World<2>&, const Model&, const WorldScale&, VectorWidth);
template void set_up(World<3>&, const Model&, const WorldScale&, VectorWidth);

}  // namespace barchan
