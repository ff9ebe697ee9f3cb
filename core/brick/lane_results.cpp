#include <algorithm>
#include <string>

#include <barchan/core/base/error.hpp>
#include <barchan/core/brick/lane.hpp>
#include <barchan/core/simd/denormals.hpp>

// The published exchange: the band at a right cut goes to the right neighbour, which computes the
// forces of its contacts and sends them back, summed for every particle of the band: sums are
// exact.
//
//   | force record of each particle of the band … | bonds of the cut … |

namespace barchan {

template <int Dim>
std::size_t Lane<Dim>::results_bytes(Side side) const {
  const auto group = BondSet<Dim>::across(side);
  const Rows band = this->band(Side::Right).rows;
  const std::int32_t rows =
      side == Side::Left ? store_.num_ghosts[index_of(Side::Left)] : band.end - band.begin;
  return (static_cast<std::size_t>(rows) * L::kForce +
          static_cast<std::size_t>(bonds_.size(group)) * BondSet<Dim>::kExported) *
         sizeof(double);
}

template <int Dim>
void Lane<Dim>::results(std::vector<double>& out) {
  const auto first =
      store_.force.begin() + std::ptrdiff_t{store_.ghost_begin(Side::Left)} * L::kForce;
  const auto last = first + std::ptrdiff_t{store_.num_ghosts[index_of(Side::Left)]} * L::kForce;
  store_.take_out(world_->grain.rounder(), store_.ghost_begin(Side::Left),
                  store_.ghost_begin(Side::Right));
  out.assign(first, last);
  store_.start_forces(world_->grain.rounder(), store_.ghost_begin(Side::Left),
                      store_.ghost_begin(Side::Right));
  bonds_.export_group(BondSet<Dim>::Left, out);
}

template <int Dim>
void Lane<Dim>::finish_right_band(std::span<const double> results) {
  const simd::DenormalsAreZero quiet;
  const Rows rows = band(Side::Right).rows;
  if (results.size() * sizeof(double) != results_bytes(Side::Right)) {
    throw RunError("a results message has " + std::to_string(results.size()) + " numbers for " +
                   std::to_string(rows.end - rows.begin) + " particles and " +
                   std::to_string(bonds_.size(BondSet<Dim>::Right)) + " bonds");
  }
  const double* f = results.data();
  for (std::int32_t i = rows.begin; i < rows.end; ++i) {
    double* row = store_.f(i);
    for (int c = 0; c < L::kForce; ++c) row[c] += *f++;
  }
  bonds_.import_group(BondSet<Dim>::Right, store_, f);
  finish_rows(rows.begin, rows.end, true);
}

template class Lane<2>;
template class Lane<3>;

}  // namespace barchan
