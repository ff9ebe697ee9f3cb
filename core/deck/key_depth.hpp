#pragma once

#include <string>
#include <string_view>

namespace barchan::deck {

/// Refuses dotted keys of more than 16 parts: trees are walked by recursion, so a hostile key must
/// not set its depth. (The TOML library bounds nested values itself.) Errors: InputError with the
/// line.
void check_key_depth(std::string_view text, const std::string& file_name);

}  // namespace barchan::deck
