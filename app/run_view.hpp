#pragma once

#include <string>
#include <string_view>
#include <vector>

// What `barchan info` tells of a run's own files. Copes with any text.

namespace barchan::app {

using Rows = std::vector<std::vector<std::string>>;

/// @param text  of a run.json; @param path  its name for messages. Errors: InputError
[[nodiscard]] Rows run_rows(std::string_view text, const std::string& path);

/// Whether a text is a series.csv rather than a table of particles.
[[nodiscard]] bool is_series(std::string_view text);
[[nodiscard]] Rows series_rows(std::string_view text, const std::string& path);

}  // namespace barchan::app
