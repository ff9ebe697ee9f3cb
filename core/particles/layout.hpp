#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace barchan {

/// Particles live in aligned records, so that a batch of pairs is aligned loads and a transpose:
///
///   2D  motion | x  y  r 1/r | vx vy u  1/m |
///       force  | fx fy ft S  |
///
///   3D  motion | x  y  z  r  | vx vy vz 1/m |
///       spin   | ux uy uz 1/r|
///       force  | fx fy fz S  | tx ty tz –   |
///
/// u = r·omega is the surface speed [m/s]; ft, (tx ty tz) are torque / r [N]; S
/// is the sum of the sizes of contact forces. A fixed particle has 1/m = 0.
template <int Dim>
struct Layout;

template <>
struct Layout<2> {
  static constexpr int kMotion = 8, kRadius = 2, kVelocity = 4, kSurface = 6, kInverseMass = 7;
  static constexpr int kSpin =
      0;  ///< doubles per spin record: the surface speed is in the motion record
  static constexpr int kForce = 4, kTorque = 2;
  static constexpr int kInverseRadius = 3;  ///< beside the surface speed
  static constexpr double kSpinGain = 2.0;  ///< m r² / I of a disk
};

template <>
struct Layout<3> {
  static constexpr int kMotion = 8, kRadius = 3, kVelocity = 4, kSurface = 0, kInverseMass = 7;
  static constexpr int kSpin = 4;
  static constexpr int kForce = 8, kTorque = 4;
  static constexpr int kInverseRadius = 3;
  static constexpr double kSpinGain = 2.5;  ///< m r² / I of a sphere
};

/// Pairs per batch; lists are padded to whole batches with pairs that never touch.
inline constexpr int kBatch = 8;

/// Memory on cache lines; much of it at once is on huge pages where the system has them. Freed by
/// std::free. Throws std::bad_alloc.
void* allocate_lines(std::size_t bytes);

/// Allocates on cache lines, one line more than asked for.
template <class T>
struct CacheLineAllocator {
  using value_type = T;
  CacheLineAllocator() = default;
  template <class U>
  explicit CacheLineAllocator(const CacheLineAllocator<U>& /*other*/) {}

  T* allocate(std::size_t n) {
    return static_cast<T*>(allocate_lines((n * sizeof(T) + 127) / 64 * 64));
  }
  void deallocate(T* p, std::size_t /*n*/) { std::free(p); }
  template <class U>
  bool operator==(const CacheLineAllocator<U>& /*other*/) const {
    return true;
  }
};

template <class T>
using AlignedVector = std::vector<T, CacheLineAllocator<T>>;

/// Resizes; where memory must grow, by a sixteenth more than asked for and not to twice as much.
template <class Vector>
void resize_with_room(Vector& v, std::size_t n) {
  if (n > v.capacity()) v.reserve(n + n / 16);
  v.resize(n);
}

}  // namespace barchan
