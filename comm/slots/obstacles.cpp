#include <barchan/comm/slots/obstacles.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace barchan {

std::vector<std::string> lines_of(std::span<const ExchangeObstacle> obstacles) {
  std::vector<std::pair<std::string, std::string>> reasons;  // reason, exchanges
  for (const ExchangeObstacle& o : obstacles) {
    const auto same =
        std::ranges::find_if(reasons, [&o](const auto& other) { return other.first == o.reason; });
    if (same == reasons.end())
      reasons.emplace_back(o.reason, o.exchange);
    else
      same->second.append(", ").append(o.exchange);
  }
  std::vector<std::string> lines;
  lines.reserve(reasons.size());
  for (const auto& [reason, exchanges] : reasons)
    lines.push_back(fmt::format("{}: {}", exchanges, reason));
  return lines;
}

}  // namespace barchan
