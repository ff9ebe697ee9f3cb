#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

#include <barchan/core/generators/close_pairs.hpp>

namespace barchan {
namespace {

using Cell = std::array<std::int64_t, 3>;

/// Grains of similar size in cells at least as wide as the reach of any two of them.
///
///   order:  grains, cell by cell          slots: hash table cell -> first grain of it in order
class SizeLevel {
 public:
  SizeLevel(const PairSpace& space, std::span<const Grain> grains,
            std::vector<std::uint32_t> members, double gap)
      : space_(space), grains_(grains), order_(std::move(members)) {
    double largest = 0.0;
    for (const std::uint32_t i : order_) largest = std::max(largest, grains_[i].radius);
    const double width = 2.0 * largest + gap;
    for (int axis = 0; axis < space_.dimension; ++axis) set_axis(axis, width);
    sort_members();
    fill_table();
  }

  /// Calls use(j) for the members around a position; stops when it returns false, and then is
  /// false.
  template <class Use>
  bool visit_around(const Vec3& position, Use use) const {
    const Cell center = cell_of(position);
    std::array<std::array<std::int64_t, 3>, 3> around{};
    std::array<int, 3> count{1, 1, 1};
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(space_.dimension); ++axis) {
      count[axis] = neighbours(axis, center[axis], around[axis]);
    }
    for (int c = 0; c < count[2]; ++c) {
      for (int b = 0; b < count[1]; ++b) {
        for (int a = 0; a < count[0]; ++a) {
          if (!visit_cell(
                  {around[0][static_cast<std::size_t>(a)], around[1][static_cast<std::size_t>(b)],
                   around[2][static_cast<std::size_t>(c)]},
                  use)) {
            return false;
          }
        }
      }
    }
    return true;
  }

  [[nodiscard]] std::span<const std::uint32_t> members() const { return order_; }

 private:
  static constexpr std::uint32_t kFree = ~std::uint32_t{0};

  void set_axis(int axis, double width) {
    const auto a = static_cast<std::size_t>(axis);
    const double length = space_.hi[axis] - space_.lo[axis];
    if (space_.periodic[a]) {
      num_cells_[a] =
          std::max<std::int64_t>(1, static_cast<std::int64_t>(std::min(1e15, length / width)));
      per_length_[a] = static_cast<double>(num_cells_[a]) / length;
    } else {
      per_length_[a] = 1.0 / width;
    }
  }

  [[nodiscard]] Cell cell_of(const Vec3& position) const {
    Cell cell{};
    for (int axis = 0; axis < space_.dimension; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const double at = std::floor((position[axis] - space_.lo[axis]) * per_length_[a]);
      cell[a] = static_cast<std::int64_t>(std::clamp(at, -4e18, 4e18));
      if (num_cells_[a] > 0) cell[a] = wrapped(a, cell[a]);
    }
    return cell;
  }

  [[nodiscard]] std::int64_t wrapped(std::size_t axis, std::int64_t cell) const {
    const std::int64_t rest = cell % num_cells_[axis];
    return rest < 0 ? rest + num_cells_[axis] : rest;
  }

  /// The cells within one of `center` along an axis, each once even if few wrap around.
  int neighbours(std::size_t axis, std::int64_t center, std::array<std::int64_t, 3>& out) const {
    int count = 0;
    for (std::int64_t shift = -1; shift <= 1; ++shift) {
      const std::int64_t cell =
          num_cells_[axis] > 0 ? wrapped(axis, center + shift) : center + shift;
      if (std::find(out.begin(), out.begin() + count, cell) == out.begin() + count) {
        out[static_cast<std::size_t>(count++)] = cell;
      }
    }
    return count;
  }

  void sort_members() {
    std::vector<std::pair<Cell, std::uint32_t>> keyed;
    keyed.reserve(order_.size());
    for (const std::uint32_t i : order_) {
      const Cell cell = cell_of(grains_[i].position);
      keyed.push_back({{cell[2], cell[1], cell[0]}, i});
    }
    std::sort(keyed.begin(), keyed.end());
    cells_.reserve(keyed.size());
    for (std::size_t at = 0; at < keyed.size(); ++at) {
      const Cell& key = keyed[at].first;
      order_[at] = keyed[at].second;
      cells_.push_back({key[2], key[1], key[0]});
    }
  }

  void fill_table() {
    slots_.assign(std::bit_ceil(2 * order_.size() + 2), kFree);
    for (std::uint32_t at = 0; at < order_.size(); ++at) {
      if (at > 0 && cells_[at] == cells_[at - 1]) continue;
      std::size_t slot = slot_of(cells_[at]);
      while (slots_[slot] != kFree) slot = (slot + 1) & (slots_.size() - 1);
      slots_[slot] = at;
    }
  }

  [[nodiscard]] std::size_t slot_of(const Cell& cell) const {
    std::uint64_t h = static_cast<std::uint64_t>(cell[0]) * 0x9e3779b97f4a7c15ULL;
    h = (h ^ (h >> 29) ^ static_cast<std::uint64_t>(cell[1])) * 0xbf58476d1ce4e5b9ULL;
    h = (h ^ (h >> 31) ^ static_cast<std::uint64_t>(cell[2])) * 0x94d049bb133111ebULL;
    return static_cast<std::size_t>(h ^ (h >> 32)) & (slots_.size() - 1);
  }

  template <class Use>
  bool visit_cell(const Cell& cell, Use use) const {
    std::size_t slot = slot_of(cell);
    while (slots_[slot] != kFree && cells_[slots_[slot]] != cell)
      slot = (slot + 1) & (slots_.size() - 1);
    if (slots_[slot] == kFree) return true;
    for (std::size_t at = slots_[slot]; at < order_.size() && cells_[at] == cell; ++at) {
      if (!use(order_[at])) return false;
    }
    return true;
  }

  const PairSpace& space_;
  std::span<const Grain> grains_;
  std::vector<std::uint32_t> order_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> slots_;
  std::array<double, 3> per_length_{};
  std::array<std::int64_t, 3> num_cells_{};  ///< of a periodic axis, else zero
};

std::vector<SizeLevel> levels_of(const PairSpace& space, std::span<const Grain> grains,
                                 double gap) {
  std::map<int, std::vector<std::uint32_t>> by_size;
  for (std::uint32_t i = 0; i < grains.size(); ++i)
    by_size[std::ilogb(grains[i].radius)].push_back(i);
  std::vector<SizeLevel> levels;
  levels.reserve(by_size.size());
  for (auto& [size, members] : by_size) levels.emplace_back(space, grains, std::move(members), gap);
  return levels;
}

}  // namespace

void for_each_close_pair(const PairSpace& space, std::span<const Grain> grains, double gap,
                         const std::function<bool(std::uint32_t, std::uint32_t)>& use) {
  const std::vector<SizeLevel> levels = levels_of(space, grains, gap);
  for (std::size_t own = 0; own < levels.size(); ++own) {
    for (const std::uint32_t i : levels[own].members()) {
      for (std::size_t other = own; other < levels.size(); ++other) {
        const bool goes_on = levels[other].visit_around(grains[i].position, [&](std::uint32_t j) {
          if (other == own && j <= i) return true;
          const double reach = grains[i].radius + grains[j].radius + gap;
          const Vec3 d = space.difference(grains[i].position, grains[j].position);
          return d.squaredNorm() > reach * reach || use(i, j);
        });
        if (!goes_on) return;
      }
    }
  }
}

}  // namespace barchan
