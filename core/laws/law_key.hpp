#pragma once

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
  bool is_of_material = false;  ///< not a key of [[pair]]
  bool is_of_rolling = false;
};

/// What constants lack, to follow what they have: "without normal_stiffness".
struct KeyGap {
  std::string what, remedy;
};

}  // namespace barchan
