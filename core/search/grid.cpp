#include <barchan/core/search/grid.hpp>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>

namespace barchan {

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
Grid<Dim>::Grid(const Domain& domain, double cutoff, std::int64_t num_particles) {
  axis_[0] = domain.strip_axis;
  for (int a = 0, k = 1; a < Dim; ++a) {
    if (a != domain.strip_axis) axis_[static_cast<std::size_t>(k++)] = a;
  }
  box_ = periodic_box(domain, Dim);
  double total = 1.0;
  for (int k = 0; k < Dim; ++k) {
    const int a = axis(k);
    const double length = domain.hi[a] - domain.lo[a];
    end_[a] = domain.hi[a];
    origin_[a] = lo_[static_cast<std::size_t>(k)] = domain.lo[a];
    periodic_[static_cast<std::size_t>(k)] = domain.periodic[static_cast<std::size_t>(a)];
    cells_[static_cast<std::size_t>(k)] =
        static_cast<int>(std::clamp(std::floor(length / cutoff), 1.0, 1e6));
    total *= cells(k);
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
  const double most = 8.0 * static_cast<double>(num_particles) + 4096.0;
  while (total > most) {  // an almost empty domain: larger cells
    auto widest = std::max_element(cells_.begin(), cells_.end());
    total /= *widest;
    *widest = (*widest + 1) / 2;
    total *= *widest;
  }
  for (int k = 0; k < Dim; ++k) {
    inverse_[static_cast<std::size_t>(k)] = cells(k) / (domain.hi[axis(k)] - domain.lo[axis(k)]);
    if (k > 0) slab_size_ *= cells(k);
  }
}

template class Grid<2>;
template class Grid<3>;

}  // namespace barchan
