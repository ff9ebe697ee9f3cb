#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "handle.hpp"

// Arrays of callers, and arrays for them.

namespace barchan::c {

inline constexpr const char* kNowhere = "a pointer to the result is NULL";

/// Errors: std::invalid_argument
template <class View>
const View& brick_of(const std::vector<View>& views, int brick) {
  require(brick >= 0 && static_cast<std::size_t>(brick) < views.size(),
          "there is no such brick: they count from 0 to num_bricks - 1");
  return views[static_cast<std::size_t>(brick)];
}

/// Errors: std::invalid_argument: a count below 0, or no data
template <class T>
std::span<const T> list_of(const T* data, std::int64_t count, const char* what) {
  require(count >= 0, "a count is below 0");
  require(data != nullptr || count == 0, what);
  return {data, static_cast<std::size_t>(count)};
}

/// Where a caller wants gathered values; NULL: not at all.
struct Room {
  std::int64_t particles;
  std::int64_t* ids;
  double* values;
  std::int64_t* count;
};

/// On rank 0. Errors: std::invalid_argument: no room
inline void give(const Simulation& simulation, const Gathered& all, const Room& room) {
  if (!simulation.communicator().is_root()) return;
  const auto n = static_cast<std::int64_t>(all.ids.size());
  if (room.count != nullptr) *room.count = n;
  if (room.ids == nullptr && room.values == nullptr) return;
  require(room.particles >= n, "there is no room for all particles");
  if (room.ids != nullptr) std::copy(all.ids.begin(), all.ids.end(), room.ids);
  if (room.values != nullptr) std::copy(all.values.begin(), all.values.end(), room.values);
}

/// Errors, here and below: std::invalid_argument: nowhere to put it
inline void give(const LoadView& from, barchan_loads* to) {
  require(to != nullptr, kNowhere);
  *to = {from.forces().data(), from.torques_by_radius().data(), static_cast<int64_t>(from.size()),
         from.forces().stride()};
}

inline void give(const StridedSpan<double>& from, barchan_values* to) {
  require(to != nullptr, kNowhere);
  *to = {from.data(), static_cast<int64_t>(from.size()), from.stride(), from.width()};
}

template <class T>
void give(std::span<const T> from, const T** to, std::int64_t* size) {
  require(to != nullptr && size != nullptr, kNowhere);
  *to = from.data();
  *size = static_cast<int64_t>(from.size());
}

/// Errors: std::invalid_argument: there is no such field, or it is no array
void give(const ParticleView& from, int field, barchan_view* to);

}  // namespace barchan::c
