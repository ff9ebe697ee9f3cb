#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

// The JSON that the command reads and writes. Parsing and printing are compiled here alone, since
// they cost every file that uses them seconds.

namespace barchan::app {

/// Keys keep their order.
using Json = nlohmann::ordered_json;

/// What a text says; `is_discarded()` where it is no JSON.
[[nodiscard]] Json parsed(std::string_view text);

/// JSON as text: in one line, or with two spaces a level. Bytes that are not UTF-8 are replaced.
[[nodiscard]] std::string compact_text(const Json& json);
[[nodiscard]] std::string indented_text(const Json& json);

/// The object in a file; null where there is no file. Errors: InputError where it holds no object.
[[nodiscard]] Json read_json(const std::string& path);
/// Replaces a file. Errors: RunError.
void write_json(const std::string& path, const Json& json);

/// Members of an object, which some other program may have written.
[[nodiscard]] double number_in(const Json& object, const char* key);  ///< 0 where there is none
[[nodiscard]] Json object_in(const Json& object, const char* key);    ///< empty where there is none

}  // namespace barchan::app
