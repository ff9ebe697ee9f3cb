#pragma once

#include <vector>

namespace barchan {

/// A rank's tie to another one beside it.
struct Link {
  int rank = -1;  ///< -1: there is nobody
  int peer = 0;   ///< the number of this link among those of the other rank
};

/// The links of a rank, by number. Two may lead to the same rank.
struct Neighbours {
  std::vector<Link> links;

  [[nodiscard]] int num_links() const { return static_cast<int>(links.size()); }
  [[nodiscard]] int rank(int link) const { return links[static_cast<std::size_t>(link)].rank; }
  [[nodiscard]] int peer(int link) const { return links[static_cast<std::size_t>(link)].peer; }
  [[nodiscard]] bool has(int link) const { return link < num_links() && rank(link) >= 0; }
};

/// The links of a strip.
inline constexpr int kLeftLink = 0, kRightLink = 1;

/// Of strip `rank` of `size`, one beside the other. With a periodic axis the left of rank 0 is the
/// last rank; with two ranks both links lead to the same rank. A lone strip has nobody beside it,
/// periodic or not: its own image is no message.
[[nodiscard]] inline Neighbours strip_neighbours(int rank, int size, bool is_periodic) {
  Neighbours beside{{{-1, kRightLink}, {-1, kLeftLink}}};
  if (size < 2) return beside;
  if (rank > 0 || is_periodic) beside.links[kLeftLink].rank = (rank + size - 1) % size;
  if (rank + 1 < size || is_periodic) beside.links[kRightLink].rank = (rank + 1) % size;
  return beside;
}

}  // namespace barchan
