#pragma once

#include <string>
#include <string_view>

namespace barchan::deck {

/// Refuses text that the TOML library must not see:
/// - dotted keys of more than 16 parts, since trees are walked by recursion (the library itself
///   bounds nested values);
/// - letters beyond ASCII outside strings and comments, which TOML does not allow, and in strings
///   of several lines: there the library reaches a branch that it takes to be unreachable.
/// Errors: InputError with the line.
void check_text(std::string_view text, const std::string& file_name);

}  // namespace barchan::deck
