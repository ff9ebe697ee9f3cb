#pragma once

#include <string>

#include <barchan/tasks/simulation.hpp>

namespace barchan {

/// Draws all particles, walls and plates: particles in the colours of their materials, or by speed
/// where there is one material only. The same picture on any number of ranks. Collective. Errors:
/// RunError.
void write_final_picture(const Simulation& simulation, const std::string& path);

}  // namespace barchan
