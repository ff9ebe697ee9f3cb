#include <barchan/core/base/exact_sum.hpp>

#include <cmath>
#include <limits>

namespace barchan {
namespace {

constexpr int kLowest = -1088;  // weight of digit 0 is 2^kLowest
constexpr int kNumeric = ExactSum::kDigits - 1;

}  // namespace

void ExactSum::add(double term) {
  if (term == 0.0) return;
  if (!std::isfinite(term)) {
    ++digits_[kNumeric];
    return;
  }
  int exponent = 0;
  const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(term, &exponent), 53));
  const int low = exponent - 53 - kLowest;  // position of the mantissa's last bit
  if (low <= -53) return;
  const std::int64_t sign = mantissa < 0 ? -1 : 1;
  auto magnitude = static_cast<unsigned __int128>(mantissa < 0 ? -mantissa : mantissa);
  int digit = 0;
  if (low < 0) {
    magnitude >>= -low;
  } else {
    digit = low / 32;
    magnitude <<= low % 32;
  }
  for (; magnitude != 0; ++digit, magnitude >>= 32) {
    digits_[static_cast<std::size_t>(digit)] +=
        sign * static_cast<std::int64_t>(magnitude & 0xffffffffU);
  }
}

void ExactSum::carry() {
  for (std::size_t d = 0; d + 1 < kNumeric; ++d) {
    const std::int64_t carry = digits_[d] >> 32;
    digits_[d] -= carry * (std::int64_t{1} << 32);
    digits_[d + 1] += carry;
  }
}

double ExactSum::value() const {
  if (digits_[kNumeric] != 0) return std::numeric_limits<double>::quiet_NaN();
  ExactSum carried = *this;
  carried.carry();
  Digits& digits = carried.digits_;
  std::size_t top = kNumeric - 1;  // the highest digit but those that only say the sign
  for (; top > 0 && (digits[top] == 0 || digits[top] == -1); --top)
    digits[top - 1] += digits[top] * (std::int64_t{1} << 32);
  const int scale = top + 4 > kNumeric ? 128 : 0;  // no part of a sum is beyond the doubles
  double sum = 0.0;
  for (std::size_t d = top + 1; d-- > 0;) {
    sum += std::ldexp(static_cast<double>(digits[d]), kLowest + 32 * static_cast<int>(d) - scale);
  }
  return std::ldexp(sum, scale);
}

}  // namespace barchan
