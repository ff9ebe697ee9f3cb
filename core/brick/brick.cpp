#include <barchan/core/brick/brick.hpp>

namespace barchan {

template <int Dim>
void Brick<Dim>::place(const Placement<Dim>& at) {
  const Grid<Dim>& grid = world->grid;
  box = at.box;
  for (std::size_t n = 0; n < links.size(); ++n) {
    BrickLink<Dim>& link = links[n];
    link.beyond = at.beyond[n];
    link.sends = cells_beside(grid, box, link.beyond);
    link.takes = cells_beside(grid, link.beyond, box);
    if (form == CutForm::Bricks && !is_shadow) continue;
    const bool is_left = link.side == Side::Left;
    const int num_slabs = grid.num_slabs();
    const int sends = is_left ? box.lo[0] : box.hi[0] - 1;
    const int takes = is_left ? (box.lo[0] + num_slabs - 1) % num_slabs : box.hi[0] % num_slabs;
    link.sends.spans[0] = {{sends, sends}};
    link.takes.spans[0] = {{takes, takes}};
  }
}

template struct Brick<2>;
template struct Brick<3>;

}  // namespace barchan
