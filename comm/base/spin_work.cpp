#include <barchan/comm/base/spin_work.hpp>

#include <algorithm>
#include <limits>

#include <barchan/core/base/clock.hpp>

namespace barchan {

SpinWork::SpinWork() {
  constexpr std::int64_t num_rounds = 40000;
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  for (int attempt = 0; attempt < 9; ++attempt) {
    const std::int64_t begin = now_ns();
    spin(num_rounds);
    least = std::min(least, now_ns() - begin);
  }
  rounds_per_second_ =
      1e9 * static_cast<double>(num_rounds) / static_cast<double>(std::max<std::int64_t>(least, 1));
}

void SpinWork::run(double seconds) {
  spin(static_cast<std::int64_t>(seconds * rounds_per_second_));
}

void SpinWork::spin(std::int64_t num_rounds) {
  std::uint64_t s = state_;
  for (std::int64_t round = 0; round < num_rounds; ++round) {
    s ^= s << 13;
    s ^= s >> 7;
    s ^= s << 17;
  }
  state_ = s;
  sink_ = s;
}

}  // namespace barchan
