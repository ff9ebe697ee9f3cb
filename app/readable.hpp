#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

// Numbers as people read them.

namespace barchan::app {

[[nodiscard]] std::string grouped(std::int64_t number);      ///< 1,234,567
[[nodiscard]] std::string readable_rate(double per_second);  ///< "12.3 M", "850 k", "91"
[[nodiscard]] std::string readable_bytes(double bytes);      ///< "1.5 GiB"
[[nodiscard]] std::string readable_time(double seconds);     ///< "0:42", "1:02:03"
[[nodiscard]] std::string readable_seconds(double seconds);  ///< "12.3 s", "4.56 ms"
[[nodiscard]] std::string percent(double share);             ///< "12 %"
[[nodiscard]] std::string range(double lo, double hi);       ///< "0.04 … 0.06", or one number

[[nodiscard]] std::size_t width_of(const std::string& text);  ///< letters, not bytes

/// Rows of words, column by column: the first `num_left` columns flush left, the others flush
/// right.
[[nodiscard]] std::string table(const std::vector<std::vector<std::string>>& rows,
                                std::size_t num_left = 1);

}  // namespace barchan::app
