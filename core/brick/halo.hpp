#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <barchan/core/brick/brick.hpp>

// What goes over a cut in a step, as bytes and back.

namespace barchan {

/// Of the rows that are ghosts beyond a link; the same until the next rebuild.
template <int Dim>
[[nodiscard]] std::size_t halo_bytes(const Brick<Dim>& brick, int link);
template <int Dim>
void pack_halo(const Brick<Dim>& brick, int link, std::span<std::byte> message);
/// Errors: RunError: another length than that of the ghosts
template <int Dim>
void unpack_halo(Brick<Dim>& brick, int link, std::span<const std::byte> message);

/// The same of any owned rows, for ghosts farther beyond a cut.
template <int Dim>
[[nodiscard]] std::size_t halo_bytes(const Brick<Dim>& brick, Rows rows);
template <int Dim>
void pack_halo(const Brick<Dim>& brick, Rows rows, std::span<std::byte> message);

// The published exchange: the band at a right cut goes to the right neighbour, which computes the
// forces of its contacts and sends them back, summed for every particle of the band: sums are
// exact.
//
//   | force record of each particle of the band … | their heat flows … | bonds of the cut … |

/// Of a results message; the same until the next rebuild. @param side  left: sent, right: received
template <int Dim>
[[nodiscard]] std::size_t results_bytes(const Brick<Dim>& brick, Side side);
/// Forces of the left cut's pairs on its ghosts, and of its bonds, after Step::finish_band(Left).
/// Replaces `out`.
template <int Dim>
void take_results(Brick<Dim>& brick, std::vector<double>& out);
/// Adds what take_results() gave on the right of the right cut. Errors: RunError: another length
template <int Dim>
void add_results(Brick<Dim>& brick, std::span<const double> results);

}  // namespace barchan
