#pragma once

#include <string>
#include <vector>

namespace barchan::app {

/// Columns to write for: what COLUMNS says, else those of the terminal behind a file descriptor,
/// else 100.
[[nodiscard]] int columns_of(int descriptor);

/// As many of the parts, from the first on and separated by commas, as fit; the first is cut where
/// it does not.
[[nodiscard]] std::string joined_within(const std::vector<std::string>& parts, int columns);

/// Rows of a label and a text, with texts that are too long for a table of so many columns broken
/// at spaces into rows of their own.
[[nodiscard]] std::vector<std::vector<std::string>> wrapped_within(
    const std::vector<std::vector<std::string>>& rows, int columns);

}  // namespace barchan::app
