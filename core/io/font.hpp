#pragma once

#include <array>
#include <cstdint>

namespace barchan {

inline constexpr int kGlyphWidth = 5;
inline constexpr int kGlyphHeight = 9;  ///< seven rows above the base line, two below

/// Rows of a printable ASCII character from the top, bit 4 leftmost; blank for what is not in the
/// font.
[[nodiscard]] const std::array<std::uint8_t, kGlyphHeight>& glyph(char character);

}  // namespace barchan
