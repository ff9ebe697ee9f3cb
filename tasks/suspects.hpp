#pragma once

#include <string>

#include <barchan/core/brick/diagnose.hpp>
#include <barchan/tasks/run_parts.hpp>

namespace barchan {

// What a message says of the particles that a run ends for, or warns of.

/// With position, velocity and what it touched.
template <int Dim>
[[nodiscard]] std::string describe(const Model& model, const Suspect& suspect,
                                   const Partners& touched);

/// Of all ranks; the same on every rank. Collective.
template <int Dim>
[[nodiscard]] std::string describe_fastest(RunParts<Dim>& run);
template <int Dim>
[[nodiscard]] std::string describe_worst_overlap(RunParts<Dim>& run);
template <int Dim>
[[nodiscard]] std::string describe_stiffest_contact(RunParts<Dim>& run);

/// For a travel beyond half the skin, whether in one step or since lists were built [m].
/// @param reach  of the contact search [m]
[[nodiscard]] std::string remedy_for_travel(double travel, double reach);

/// "wall 'lid'"
[[nodiscard]] std::string name_of_wall(const Model& model, std::int32_t wall);

}  // namespace barchan
