#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>

#include <barchan/comm/base/communicator.hpp>
#include <barchan/core/model/digest.hpp>
#include <barchan/core/model/model.hpp>

// What is asked of the numbers and lists that a caller gives.

namespace barchan {

[[nodiscard]] bool are_finite(std::span<const double> values);

/// Errors: InputError on every rank: ranks give different numbers, or some that are not finite.
void require_same(const Communicator& communicator, const char* call, const Vec3& values);

/// Errors: InputError: in 2D a third component.
void require_plane(const Model& model, const char* call, const Vec3& v);

template <class T>
[[nodiscard]] std::uint64_t hash_of(std::span<const T> values) {
  return hash_of_bytes(std::as_bytes(values));
}
/// @return what is wrong, on every rank; empty: nothing
[[nodiscard]] std::string differing_lists(const Communicator& communicator,
                                          std::initializer_list<std::uint64_t> hashes);

}  // namespace barchan
