#pragma once

#include <string>
#include <vector>

#include <barchan/core/model/model.hpp>

// What a deck's numbers foretell, beside the stable step (stability.hpp). All pure and the same on
// every rank.

namespace barchan {

/// The skin of a deck that gives none: a share of the mean radius
/// (docs/measurements/performance.md). Where the start or a fall to the end of the domain makes
/// something so fast that it may pass the smallest particle in a step: twice its travel in a step,
/// so that lists have all that it may pass, but at most the mean diameter.
[[nodiscard]] double default_skin(const Model& model, const ParticleSet& particles);

/// Where particles or plates would be so fast that a step may skip contacts: from the speeds of the
/// start, and from a free fall to the end of the domain. Two that move by more than the smaller
/// radius against each other in a step end a run when they pass each other (brick/passage.hpp).
[[nodiscard]] std::vector<std::string> speed_warnings(const Model& model,
                                                      const ParticleSet& particles);

/// Lengths that a run lives on, against the spacing of doubles where coordinates are largest.
struct Precision {
  double coordinate = 0.0;  ///< the largest [m]
  double spacing = 0.0;     ///< of doubles there [m]
  double travel = 0.0;      ///< the largest of a step, or of a fall by a radius; 0: unknown [m]
  double least_overlap = 0.0, most_overlap = 0.0;  ///< by weight or impact; 0: unknown [m]
  double radius = 0.0;                             ///< the smallest [m]
};
[[nodiscard]] Precision precision_of(const Model& model, const ParticleSet& particles);

/// Where rounding leaves fewer than three digits of motion or overlaps.
[[nodiscard]] std::vector<std::string> precision_warnings(const Model& model,
                                                          const ParticleSet& particles);
/// Refuses what rounding would leave nothing right of: fewer than one digit.
/// Errors: InputError, with what to subtract from all positions.
void check_precision(const Model& model, const ParticleSet& particles);

}  // namespace barchan
