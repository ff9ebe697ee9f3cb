#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <barchan/core/model/model.hpp>
#include <barchan/core/search/cell_box.hpp>
#include <barchan/tasks/cut_shape.hpp>

namespace barchan {

/// Reach of the contact search [m]: two of the largest particles, or the longest bond with a tenth
/// of stretch, and the skin.
[[nodiscard]] double search_reach(const Model& model, const ParticleSet& particles, double skin);

/// Of every particle the cell that it lies in.
template <int Dim>
[[nodiscard]] std::vector<CellAt<Dim>> cells_of(const Grid<Dim>& grid, const ParticleSet& set);

/// How the domain may be cut.
struct CutPlan {
  CutRoom room;
  std::array<double, 3> cell{};           ///< lengths along the grid's axes [m]
  std::vector<std::array<int, 3>> cells;  ///< of all particles at the start

  /// Particles of each rank.
  [[nodiscard]] std::vector<std::int64_t> rank_counts(const CutShape& shape) const;
};

/// The grid that a run begins with. Pure. Errors: InputError for a periodic domain shorter than
/// two reaches.
[[nodiscard]] CutPlan plan_cuts(const Model& model, const ParticleSet& particles);

}  // namespace barchan
