#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <barchan/core/model/model.hpp>
#include <barchan/core/search/grid.hpp>

namespace barchan {

/// Slabs that a strip has at least.
inline constexpr int kMinSlabs = 2;

/// Reach of the contact search [m]: two of the largest particles, or the longest bond with a tenth
/// of stretch, and the skin.
[[nodiscard]] double search_reach(const Model& model, const ParticleSet& particles, double skin);

/// Of every particle the slab that it lies in.
template <int Dim>
[[nodiscard]] std::vector<int> slabs_of(const Grid<Dim>& grid, const ParticleSet& set);
/// How many particles lie in each slab.
[[nodiscard]] std::vector<std::int64_t> count_slabs(std::span<const int> slabs, int num_slabs);

/// How the domain is cut along its strip axis.
struct StripPlan {
  int axis = 0;
  double slab_width = 0.0;                ///< [m]
  std::vector<std::int64_t> slab_counts;  ///< particles at the start

  [[nodiscard]] int most_ranks() const;
  /// Particles of each of `num_strips` strips. @pre num_strips <= most_ranks()
  [[nodiscard]] std::vector<std::int64_t> strip_counts(int num_strips) const;
};

/// The cuts that a run would begin with. Pure. Errors: InputError for a periodic domain shorter
/// than two reaches.
[[nodiscard]] StripPlan plan_strips(const Model& model, const ParticleSet& particles);

/// Errors: InputError, at the deck's domain, for more ranks than strips fit into so many cells
/// along the strip axis.
void check_ranks(int num_ranks, const Model& model, int num_slabs);

}  // namespace barchan
