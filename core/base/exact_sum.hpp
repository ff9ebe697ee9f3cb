#pragma once

#include <array>
#include <cstdint>

namespace barchan {

/// A sum of doubles that does not depend on their order: a fixed-point number of 32-bit digits from
/// 2^-1088 to 2^1056.
///
/// Every digit is an int64, so partial sums of up to 2^30 terms may be added digit by digit in any
/// order, on any rank (a sum of integers). No bit of a double lies below or above, so units may be
/// as small or as large as they like. Non-finite terms make the sum NaN.
class ExactSum {
 public:
  static constexpr int kDigits = 68;
  using Digits = std::array<std::int64_t, kDigits>;

  void add(double term);
  void add(const ExactSum& other) {
    for (std::size_t d = 0; d < kDigits; ++d) digits_[d] += other.digits_[d];
  }
  /// The same sum with every digit but the highest in [0, 2^32). A sum that grows through a whole
  /// run needs this at least every 2^30 terms.
  void carry();
  /// The sum, rounded once (to within an ulp); infinite beyond the range of doubles.
  [[nodiscard]] double value() const;
  [[nodiscard]] const Digits& digits() const { return digits_; }
  [[nodiscard]] Digits& digits() { return digits_; }

 private:
  Digits digits_{};  ///< the last one counts non-finite terms
};

}  // namespace barchan
