#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include <barchan/app/report/page.hpp>

namespace barchan::app {

/// Steps of a trace, both included.
using StepWindow = std::pair<std::int64_t, std::int64_t>;

/// What a page shows of a trace.json:
///
///     steps      [first, last]
///     workers    of each rank
///     names      of slices
///     slices     [rank, worker, name, begin, duration, step]; times in µs from the first slice on
///     messages   [rank, worker, sent, rank, worker, noticed, step]
///
/// @param steps  none: the last ones, as many as a page takes
/// Errors: InputError where the file is not a trace of barchan or has none of the steps.
[[nodiscard]] PageData trace_window(const std::string& path,
                                    const std::optional<StepWindow>& steps);

}  // namespace barchan::app
