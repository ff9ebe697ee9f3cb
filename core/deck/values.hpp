#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <barchan/core/base/vec.hpp>
#include <barchan/core/deck/node.hpp>
#include <barchan/core/deck/schema.hpp>

// Single values of a deck, checked. Every function throws InputError at the value's place.

namespace barchan::deck {

[[noreturn]] void fail_type(const Node& node, std::string_view what, std::string_view expected,
                            std::string_view remedy);

double finite_number(const Node& node, std::string_view what);

/// `dimension` finite numbers; the third stays zero in 2D.
Vec3 finite_vector(const Node& node, int dimension, std::string_view what);

double checked_number(const Node& node,
                      const KeySpec& spec);  ///< finite and in the range of its type

/// Written as one, or as a number without a fraction, such as 1e3.
std::int64_t whole_number(const Node& node, std::string_view what);
std::int64_t checked_integer(const Node& node, const KeySpec& spec);
std::string checked_string(const Node& node,
                           const KeySpec& spec);  ///< a Choice must be one of its words

}  // namespace barchan::deck
