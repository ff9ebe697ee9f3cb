#pragma once

#include <cstdint>

namespace barchan {

/// Counter-based random numbers: number n of a seed is a hash of both, so every rank and compiler
/// draws the same. The mixing function is SplitMix64 (Steele, Lea & Flood 2014,
/// doi:10.1145/2714064.2660195).
class CounterRandom {
 public:
  /// @param stream  separates what is drawn from the same seed for different purposes
  CounterRandom(std::uint64_t seed, std::uint64_t stream) : key_(mix(seed + mix(stream))) {}

  [[nodiscard]] std::uint64_t bits() { return mix(key_ + ++counter_ * kStep); }

  /// Uniform in [0, 1): 53 bits.
  [[nodiscard]] double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  [[nodiscard]] double uniform(double lo, double hi) { return lo + (hi - lo) * uniform(); }

 private:
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15ULL;

  static constexpr std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }

  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};

}  // namespace barchan
