#pragma once

#include <string>

namespace barchan::app {

/// Prints a line of warning on stderr.
void print_warning(const std::string& text);

}  // namespace barchan::app
