#pragma once

#include <span>
#include <vector>

#include <barchan/core/generators/close_pairs.hpp>
#include <barchan/core/generators/grain.hpp>
#include <barchan/core/model/particle_source.hpp>

namespace barchan {

/// Where grains are packed: walls at lo and hi of the axes that are not periodic, and holes that
/// stay free.
struct PackSpace {
  PairSpace box;
  std::vector<Hole> holes;

  [[nodiscard]] double volume() const;  ///< of the box that no hole takes [m²] or [m³]

  /// Moves a grain to the nearest place off walls and holes, and into the box on periodic axes.
  void confine(Grain& grain) const;

  /// How deep a grain reaches into walls and holes [m], never negative.
  [[nodiscard]] double intrusion(const Grain& grain) const;
};

/// Moves overlapping grains apart: minimises the energy of soft grains, sum of overlap²/2, by FIRE
/// (Bitzek et al. 2006, doi:10.1103/PhysRevLett.97.170201), until no overlap is more than
/// `tolerance` of the smaller radius, or forces balance, or after `max_iterations`. Single-threaded
/// and deterministic.
void relax(const PackSpace& space, std::vector<Grain>& grains, double tolerance,
           int max_iterations);

/// Largest overlap of each grain over the smaller radius of the pair; walls and holes count too. A
/// pair of very different sizes counts for its smaller grain only, since that is the one to take
/// out.
[[nodiscard]] std::vector<double> overlap_ratios(const PackSpace& space,
                                                 std::span<const Grain> grains);

}  // namespace barchan
