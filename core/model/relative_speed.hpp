#pragma once

#include <barchan/core/model/model.hpp>

namespace barchan {

/// A bound of how fast two particles may meet that come from where they started, by a fall through
/// the domain and by what pushes them [m/s]. Pure; the same on every rank.
[[nodiscard]] double relative_speed(const Model& model, const ParticleSet& particles);

}  // namespace barchan
