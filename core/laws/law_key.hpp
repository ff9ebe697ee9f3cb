#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include <barchan/core/laws/contact_constants.hpp>

namespace barchan {

/// A key in a deck's [[material]] and [[pair]], and where its number goes.
struct LawKey {
  enum class Range { Positive, NotNegative, Restitution, Poisson, Flag };

  const char* name;
  Range range;
  const char* unit;
  const char* fallback;  ///< "none" or a value
  const char* meaning;
  void (*set)(ContactConstants& pair, double value);  ///< a flag is 1 or 0
  int instead_of = -1;  ///< place of the key whose place it takes: of all such keys one may stand
  bool is_of_material = false;                                   ///< not a key of [[pair]]
  enum class Part { Law, Rolling, Dmt, Sjkr } part = Part::Law;  ///< which a deck chooses
};

/// The keys of a law and of what is built on it.
template <std::size_t N, std::size_t M>
std::array<LawKey, N + M> joined_keys(const std::array<LawKey, N>& first,
                                      const std::array<LawKey, M>& more) {
  std::array<LawKey, N + M> all{};
  std::copy(first.begin(), first.end(), all.begin());
  std::copy(more.begin(), more.end(), all.begin() + N);
  for (std::size_t k = N; k < N + M; ++k) {
    if (all[k].instead_of >= 0) all[k].instead_of += static_cast<int>(N);
  }
  return all;
}

/// What constants lack, to follow what they have: "without normal_stiffness".
struct KeyGap {
  std::string what, remedy;
};

}  // namespace barchan
