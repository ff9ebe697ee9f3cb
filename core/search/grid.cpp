#include <barchan/core/search/grid.hpp>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

/// Along one axis: a recut adds up particles by each axis' cells, over all ranks.
constexpr double kMostCells = 1e5;

}  // namespace

PeriodicBox periodic_box(const Domain& domain, int dimension) {
  PeriodicBox box;
  for (int a = 0; a < dimension; ++a) {
    if (!domain.periodic[static_cast<std::size_t>(a)]) continue;
    box.length[a] = domain.hi[a] - domain.lo[a];
    box.inverse[a] = 1.0 / box.length[a];
  }
  return box;
}

template <int Dim>
Grid<Dim>::Grid(const Domain& domain, double cutoff) {
  axis_[0] = domain.strip_axis;
  for (int a = 0, k = 1; a < Dim; ++a) {
    if (a != domain.strip_axis) axis_[static_cast<std::size_t>(k++)] = a;
  }
  box_ = periodic_box(domain, Dim);
  for (int k = 0; k < Dim; ++k) {
    const int a = axis(k);
    const double length = domain.hi[a] - domain.lo[a];
    end_[a] = domain.hi[a];
    origin_[a] = lo_[static_cast<std::size_t>(k)] = domain.lo[a];
    periodic_[static_cast<std::size_t>(k)] = domain.periodic[static_cast<std::size_t>(a)];
    cells_[static_cast<std::size_t>(k)] =
        static_cast<int>(std::clamp(std::floor(length / cutoff), 1.0, kMostCells));
    if (!is_periodic(k)) continue;
    if (length < 2.0 * cutoff) {
      throw InputError(
          domain.place,
          fmt::format("the domain is periodic and {:.6g} m long along {}, shorter than "
                      "twice the reach of a contact",
                      length, "xyz"[a]),
          fmt::format("make it at least {:.6g} m", 2.0 * cutoff));
    }
  }
  for (int k = 0; k < Dim; ++k) {
    inverse_[static_cast<std::size_t>(k)] = cells(k) / (domain.hi[axis(k)] - domain.lo[axis(k)]);
    if (k > 0) slab_size_ *= cells(k);
  }
}

template class Grid<2>;
template class Grid<3>;

}  // namespace barchan
