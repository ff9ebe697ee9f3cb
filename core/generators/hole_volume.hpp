#pragma once

#include <span>
#include <vector>

#include <barchan/core/generators/close_pairs.hpp>
#include <barchan/core/model/particle_source.hpp>

namespace barchan {

/// The holes, and their images across periodic axes that reach into the box. An axis is a period
/// long, or zero where it does not wrap.
[[nodiscard]] std::vector<Hole> with_images(std::span<const Hole> holes, const PairSpace& box,
                                            const Vec3& period);

/// Area [m²] or volume [m³] that holes take from a box: of each what lies in the box, of what
/// several share once, and across periodic axes their images too. Closed form in 2D, and in 3D for
/// a hole that lies in the box and meets no other; else by quadrature, with an error below 1e-9 of
/// the box around the holes that overlap. Pure.
[[nodiscard]] double hole_volume(const PairSpace& box, std::span<const Hole> holes);

}  // namespace barchan
