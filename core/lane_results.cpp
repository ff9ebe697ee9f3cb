#include <string>

#include <barchan/core/error.hpp>
#include <barchan/core/lane.hpp>

// The published exchange: the band at a right cut goes to the right neighbour, which computes the
// forces of each contact and sends them back.
//
//   | number of contacts | force records … | bonds of the cut … |
//
// The unused component of a force record holds the number of the ghost that it belongs to.

namespace barchan {
namespace {

constexpr int kNumberSlot = 3;  // unused component of a force record

template <int Dim>
bool is_zero(const double* f) {
  for (int c = 0; c < Layout<Dim>::kForce; ++c) {
    if (f[c] != 0.0) return false;
  }
  return true;
}

}  // namespace

template <int Dim>
std::size_t Lane<Dim>::max_results_bytes(Side side) const {
  const Band& band = bands_[side];
  const auto group = side == Left ? BondSet<Dim>::Left : BondSet<Dim>::Right;
  const auto pairs = static_cast<std::size_t>(2 * band.across.size() + 64);
  const auto bonds = static_cast<std::size_t>(bonds_.size(group)) * BondSet<Dim>::kExported;
  return (1 + pairs * L::kForce + bonds) * sizeof(double);
}

template <int Dim>
void Lane<Dim>::results(std::vector<double>& out) const {
  const Band& band = bands_[Left];
  const std::int32_t ghosts = store_.ghost_begin(Left);
  out.assign(1, 0.0);
  const auto append = [&](std::size_t k, std::int32_t i, std::int32_t j) {
    const double* f = band.across.result.data() + k * L::kForce;
    if (is_zero<Dim>(f)) return;
    out[0] += 1.0;
    out.insert(out.end(), f, f + L::kForce);
    out[out.size() - L::kForce + kNumberSlot] = (store_.is_owned(i) ? j : i) - ghosts;
  };
  for (const PairBlock& block : band.blocks) block.for_each_worked_on(band.across, append);
  bonds_.export_group(BondSet<Dim>::Left, out);
}

template <int Dim>
void Lane<Dim>::finish_right_band(std::span<const double> results) {
  const Band& band = bands_[Right];
  const auto num_bonds =
      static_cast<std::size_t>(bonds_.size(BondSet<Dim>::Right)) * BondSet<Dim>::kExported;
  const std::size_t num_contacts =
      results.size() > num_bonds ? (results.size() - 1 - num_bonds) / L::kForce : 0;
  if (results.size() != 1 + num_contacts * L::kForce + num_bonds ||
      results[0] != static_cast<double>(num_contacts)) {
    throw RunError("a results message has " + std::to_string(results.size()) +
                   " numbers, which do not fit its contacts and " +
                   std::to_string(bonds_.size(BondSet<Dim>::Right)) + " bonds");
  }
  const double* f = results.data() + 1;
  const double num_rows = band.rows.end - band.rows.begin;
  for (std::size_t n = num_contacts; n > 0; --n, f += L::kForce) {
    if (!(f[kNumberSlot] >= 0.0 && f[kNumberSlot] < num_rows))
      throw RunError("a results message names a particle that is not in the band");
    const std::int32_t own = band.rows.begin + static_cast<std::int32_t>(f[kNumberSlot]);
    double* row = store_.f(own);
    // The force is on the lower particle of the pair, and so is this one unless the ghosts come
    // first.
    for (int c = 0; c < Dim; ++c) row[c] = band.ghosts_first ? row[c] - f[c] : row[c] + f[c];
    for (int c = L::kTorque; c < L::kTorque + kSpins<Dim>; ++c) row[c] += f[c];
  }
  finish_sums(Right);
  bonds_.import_group(BondSet<Dim>::Right, store_, f);
  finish_rows(band.rows.begin, band.rows.end, true);
}

template class Lane<2>;
template class Lane<3>;

}  // namespace barchan
