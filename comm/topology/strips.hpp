#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace barchan {

// Strips: the grid's slabs along the strip axis (one cell thick) are dealt to ranks in contiguous
// runs. `cuts` has num_strips + 1 entries, 0 = cuts[0] < cuts[1] < … < cuts[num_strips] = number of
// slabs; strip i owns the slabs cuts[i] … cuts[i+1] - 1. Pure functions: every rank that calls them
// with the same loads gets the same cuts.

/// How many strips of at least `min_slabs` slabs fit.
[[nodiscard]] int max_strips(int num_slabs, int min_slabs);

/// Cuts for strips of equal loads, each at least `min_slabs` wide: cut i lies where the sum of the
/// loads is nearest to i / num_strips of the total.
/// @param load_of_slab  particles, or what they cost, in each slab; all zero: equal widths
/// Errors: InputError when that many strips do not fit (says how many do).
[[nodiscard]] std::vector<int> cut_equal(std::span<const std::int64_t> load_of_slab, int num_strips,
                                         int min_slabs);

/// Cuts anew when strips have drifted apart; the old cuts while the largest load is at most 1.03 ×
/// the mean, and where moving them would not make the largest smaller by a hundredth. Every new cut
/// satisfies old_cuts[i-1] < new_cuts[i] < old_cuts[i+1], so a particle that lies in its old strip,
/// or at most one slab beside it, finds its new owner in the same or an adjacent strip. Cuts that
/// are far off get there in several calls.
/// @pre old_cuts are valid for the same number of slabs and `min_slabs`
[[nodiscard]] std::vector<int> recut(std::span<const int> old_cuts,
                                     std::span<const std::int64_t> load_of_slab, int num_strips,
                                     int min_slabs);

/// Largest load of a strip over the mean; 1 when there is none.
[[nodiscard]] double imbalance(std::span<const int> cuts,
                               std::span<const std::int64_t> load_of_slab);

/// The strip that owns `slab`. @pre 0 <= slab < cuts.back()
[[nodiscard]] int strip_of(std::span<const int> cuts, int slab);

}  // namespace barchan
