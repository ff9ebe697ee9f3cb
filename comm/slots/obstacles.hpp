#pragma once

#include <span>
#include <string>
#include <vector>

namespace barchan {

/// An exchange that does not work between these ranks.
struct ExchangeObstacle {
  std::string exchange;
  std::string reason;  ///< with the remedy
};

/// "put-flag, get: reason": one line for each reason, with all the exchanges that it holds for.
[[nodiscard]] std::vector<std::string> lines_of(std::span<const ExchangeObstacle> obstacles);

}  // namespace barchan
