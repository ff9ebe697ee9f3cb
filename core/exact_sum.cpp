#include <barchan/core/exact_sum.hpp>

#include <cmath>
#include <limits>

namespace barchan {
namespace {

constexpr int kLowest = -1088;  // weight of digit 0 is 2^kLowest
constexpr int kNumeric = ExactSum::kDigits - 1;

}  // namespace

void ExactSum::add(double term) {
  if (term == 0.0) return;
  if (!std::isfinite(term) || std::fabs(term) >= 0x1p300) {
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
  double sum = 0.0;
  for (int d = kNumeric - 1; d >= 0; --d) {
    sum += std::ldexp(static_cast<double>(carried.digits_[static_cast<std::size_t>(d)]),
                      kLowest + 32 * d);
  }
  return sum;
}

}  // namespace barchan
