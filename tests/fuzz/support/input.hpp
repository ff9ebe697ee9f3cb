#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <barchan/core/base/error.hpp>

// What fuzzing targets have in common. A target calls a reader; an error that the reader promises
// is as good as success, anything else ends the process.

namespace barchan::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

inline std::span<const std::byte> bytes_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const std::byte*>(data), size};
}

/// Runs `read` and lets it say that the input is wrong.
template <class Read>
void expect_input_error(Read&& read) {
  try {
    read();
  } catch (const InputError&) {
  }
}

/// The same for what came from another rank.
template <class Read>
void expect_run_error(Read&& read) {
  try {
    read();
  } catch (const RunError&) {
  }
}

}  // namespace barchan::fuzz
