#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <barchan/core/model/model.hpp>
#include <barchan/core/search/grid.hpp>
#include <barchan/tasks/lane_map.hpp>

namespace barchan {

/// Cells that a strip is wide at least, so that a particle is in one band; a brick needs one.
inline constexpr int kMinSlabs = 2;

/// The grid that is cut, as its cuts see it.
struct CutRoom {
  std::array<int, 3> cells{1, 1, 1};  ///< along the grid's axes
  std::array<int, 3> filled{};        ///< from the first to the last with particles; 0: all
  std::array<int, 3> axes{0, 1, 2};   ///< which of x, y, z these are
  std::array<bool, 3> is_periodic{};
  int dimension = 3;
  std::int64_t num_particles = 0;

  [[nodiscard]] int most_strips(int min_cells = kMinSlabs) const;
  [[nodiscard]] double num_cells() const;
  [[nodiscard]] int num_filled(std::size_t axis) const {
    return filled[axis] > 0 ? filled[axis] : cells[axis];
  }
};
template <int Dim>
[[nodiscard]] CutRoom room_of(const Grid<Dim>& grid, std::int64_t num_particles);

/// What cutting asks for.
struct CutRequest {
  CutWish wish;
  int ranks = 1, threads = 1;  ///< threads of a rank: as many lanes, where they fit
  bool needs_strips = false;   ///< the exchange `return`
  SourcePlace place{};         ///< of the domain, in the deck
  int depth = 0;               ///< of shadows, between ranks
  SourcePlace depth_place{};   ///< in the deck
};

/// Whether so many ranks fit as bricks of any shape, or as strips. Pure.
[[nodiscard]] bool fits_somehow(int ranks, CutWish::Kind kind, const CutRoom& room);

/// The deepest shadows with which so many ranks fit as strips. Pure.
[[nodiscard]] int most_depth(int ranks, const CutRoom& room);

/// How ranks and their lanes are cut: as asked for, or in the way with the smallest predicted step;
/// bricks only where they are clearly better than strips. Pure.
/// Errors: InputError, with what would fit.
[[nodiscard]] CutShape choose_cuts(const CutRequest& request, const CutRoom& room);

/// A step of the largest lane, in steps of a particle. @pre it fits
[[nodiscard]] double predicted_step(const CutShape& shape, const CutRoom& room);

/// Cells that a lane is wide at least. Behind shadows and the halo of the last one a band remains.
[[nodiscard]] inline int min_cells(const CutShape& shape) {
  if (shape.form == CutForm::Bricks) return 1;
  return shape.depth > 0 ? shape.depth + kMinSlabs : kMinSlabs;
}

/// "strips", "4 x 1 x 2"; along x, y and z.
[[nodiscard]] std::string describe(const CutShape& shape, const CutRoom& room);
/// Of ranks, along x, y and z. @param shape  along the grid's axes
[[nodiscard]] std::array<int, 3> along_xyz(const std::array<int, 3>& shape, const CutRoom& room);

/// "auto", "strips" or numbers such as "2,2,1". Errors: InputError.
[[nodiscard]] CutWish parse_cuts(const std::string& text);

}  // namespace barchan
