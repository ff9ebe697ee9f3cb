#pragma once

#include <string>

#include <barchan/core/base/vec.hpp>

namespace barchan {

/// "(1.5, 2)" in 2D, "(1.5, 2, 0.3)" in 3D, with six digits: as messages show a place or a
/// velocity.
[[nodiscard]] std::string in_brackets(const double* components, int dimension);
[[nodiscard]] std::string in_brackets(const Vec3& v, int dimension);

}  // namespace barchan
