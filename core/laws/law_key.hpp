#pragma once

namespace barchan {

/// A key with a number in a deck's [[material]] and [[pair]], and where the number goes.
template <class Pair>
struct LawKey {
  enum class Range { Positive, NotNegative, Restitution };

  const char* name;
  Range range;
  const char* unit;
  const char* fallback;  ///< "required", "none" or a number
  const char* meaning;
  void (*set)(Pair& pair, double value);
  int instead_of = -1;  ///< place of the key whose place it takes: of all such keys one may stand
};

}  // namespace barchan
