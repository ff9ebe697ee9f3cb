#pragma once

#include <string>

#include <barchan/app/report/page.hpp>

namespace barchan::app {

/// A series.csv as {columns, rows}: numbers, null where a cell is empty, and at most 4,000 rows
/// evenly over the file. Errors: InputError.
[[nodiscard]] PageData series_data(const std::string& path);

}  // namespace barchan::app
