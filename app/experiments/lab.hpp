#pragma once

#include <string>
#include <vector>

#include <barchan/app/experiments/axes.hpp>

// Runs between emulated hosts: bench/netlab, installed as barchan-netlab.

namespace barchan::app {

/// "hosts=2,delay=0:200us:1ms,realtime" as axes, hosts first. Errors: InputError for unknown words.
[[nodiscard]] std::vector<Axis> parse_lab(const std::string& text);

/// Whether an axis is one of the lab's.
[[nodiscard]] bool is_of_lab(const std::string& axis);

/// The command of the lab: $BARCHAN_NETLAB, beside this program, in PATH, or in the source tree
/// that this program was built in. Errors: InputError where there is none.
[[nodiscard]] std::string find_netlab();

/// Asks the lab whether it can be built as points want it, once for each network.
/// Errors: InputError with its words.
void check_lab(const std::string& netlab, const std::vector<Point>& points);

/// The words that start ranks on the lab's hosts at a point. Errors: InputError where the ranks
/// cannot be shared out equally among the hosts.
[[nodiscard]] std::vector<std::string> lab_words(const std::string& netlab, const Point& point);

}  // namespace barchan::app
