#pragma once

#include <cstddef>
#include <span>

namespace barchan::fuzz {

/// Reads the header of a message as an exchange does. In a file of its own, since comm and core
/// each have a Lane.
void read_slot_header(std::span<const std::byte> bytes);

}  // namespace barchan::fuzz
