#pragma once

#include <string>
#include <vector>

#include <barchan/app/experiments/measurements.hpp>
#include <barchan/app/experiments/statistics.hpp>
#include <barchan/app/json_text.hpp>

namespace barchan::app {

/// Two sets of runs that are to be compared, of points that match.
struct PointPair {
  Point point;  ///< what both have in common
  std::vector<const Measurement*> a, b;
  bool are_paired = false;  ///< repetition by repetition, of one sweep
  Interval ratio;           ///< of b's step to a's

  /// "faster", "slower", "no difference seen" or "too few runs to tell".
  [[nodiscard]] std::string verdict() const;
};

/// The points of two selections that are equal but for what they were selected by; where each has
/// one, these two. Errors: InputError where none match.
[[nodiscard]] std::vector<PointPair> match(const Selection& a, const Selection& b,
                                           double confidence);

/// Something that has two values, such as the name of the exchange.
struct Difference {
  std::string what, a, b;
};
/// What differs between two runs in deck, machine and library, and in how they were carried out.
[[nodiscard]] std::vector<Difference> differences(const Json& a, const Json& b);

/// Parts of a step, [µs] in the median of each side.
struct PartTimes {
  std::string part;
  double a = 0.0, b = 0.0;
};
[[nodiscard]] std::vector<PartTimes> parts_of(const PointPair& pair);

}  // namespace barchan::app
