#pragma once

#include <cmath>
#include <cstdint>

#include <barchan/core/kernels/law_view.hpp>

namespace barchan {

/// Box lengths for the minimum image; zero inverse where an axis is not periodic.
struct PeriodicBox {
  double length[3] = {0, 0, 0};
  double inverse[3] = {0, 0, 0};
  /// A difference along an axis, to the nearest image.
  [[nodiscard]] double nearest(double d, int axis) const {
    return d - length[axis] * std::rint(d * inverse[axis]);
  }
  [[nodiscard]] bool any() const { return inverse[0] != 0 || inverse[1] != 0 || inverse[2] != 0; }
};

/// What a pair kernel works on: pairs [begin, end), whole batches.
struct PairJob {
  const double* motion = nullptr;   ///< records of all particles and ghosts (layout.hpp)
  const double* spin = nullptr;     ///< 3D
  double* force = nullptr;          ///< summed into: exact, so that order is of no account
  const std::int32_t* i = nullptr;  ///< first particle of each pair
  const std::int32_t* j = nullptr;
  const std::uint8_t* code = nullptr;  ///< law of each pair
  double* history = nullptr;           ///< per batch: number by number, eight lanes each
  std::int64_t begin = 0, end = 0;
  double dt = 0.0;
  PeriodicBox box;
  LawView laws;
};

using PairKernel = void (*)(const PairJob&);
/// Writes one byte per batch: bit q is set where candidate q of the batch touches, or misses it by
/// less than `margin` [m].
using NarrowKernel = void (*)(const PairJob&, double margin, std::uint8_t* masks);

enum class VectorWidth { Scalar = 1, Avx2 = 4, Avx512 = 8 };

}  // namespace barchan
