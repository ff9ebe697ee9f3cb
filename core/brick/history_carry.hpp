#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <barchan/core/brick/brick.hpp>
#include <barchan/core/brick/departure.hpp>
#include <barchan/core/brick/lists.hpp>
#include <barchan/core/brick/messages.hpp>
#include <barchan/core/kernels/history_table.hpp>

namespace barchan {

/// Where the rows of a brick go in a rebuild; by row.
struct Leavers {
  /// The number of a link, or one of these. Gone: out of the domain
  enum Way : std::int8_t { Stays = -1, Gone = -2 };
  std::vector<std::int8_t> way;
  std::vector<std::int32_t>
      number;  ///< of every row that leaves, its place among those of its link
  std::vector<std::int64_t> removed;  ///< ids that go, of any brick; ascending

  [[nodiscard]] std::int8_t of(std::int32_t row) const {
    return way[static_cast<std::size_t>(row)];
  }
  [[nodiscard]] bool leaves(std::int32_t row) const { return of(row) >= 0; }
  [[nodiscard]] bool is_removed(std::int64_t id) const;
};

/// The history of contacts on its way through a rebuild. Pairs of rows that both stay are carried
/// by row; all others as loose contacts, by the row of one particle and the id of the other.
template <int Dim>
class HistoryCarry {
 public:
  explicit HistoryCarry(Brick<Dim>& brick) : brick_(brick) {}

  // ---- out of old lists
  /// Takes all histories; those of leavers go to `out`.
  void collect(const Leavers& leavers, std::vector<Migration<Dim>>& out);
  // From elsewhere, by source rows
  /// @return its history, zero, as seen from the row
  double* add_contact(std::int32_t row, std::int64_t partner) {
    return loose_.push({row, partner});
  }
  void add_wall_contact(const WallContact<Dim>& contact) { walls_.push_back(contact); }
  /// Nothing is carried.
  void clear();

  /// Copies to a shadow what is carried of contacts and walls by rows of some.
  /// @param new_row  of every source row. @param of  rows, apart. @param out  one for each: what
  /// is added is by the place among the rows
  /// @pre rows and cells are those of the brick to come, without ghosts
  void copy(std::span<const std::int32_t> new_row, std::span<const Rows> of,
            std::vector<Migration<Dim>>& out) const;

  // ---- into new ones
  /// @param new_row  of every source row. @pre lists and cells of the brick and its ghosts
  void put_back(std::span<const std::int32_t> new_row);

  /// What rebuilds have found too much or too little, since the start: links after them less links
  /// before them. Summed over all bricks it is zero, or something was lost.
  [[nodiscard]] const LinkCounts& imbalance() const { return imbalance_; }
  LinkCounts& imbalance() { return imbalance_; }
  void lose(Loss what) { loss_ = what; }  ///< tests: one of these, in the next rebuild
  /// Whether to lose one of these now.
  bool loses(Loss what) { return loss_ == what && std::exchange(loss_, Loss::Nothing) == what; }
  [[nodiscard]] std::size_t bytes() const { return kept_.bytes() + loose_.bytes(); }

 private:
  /// Out of old lists.
  struct Way {
    const Leavers& leavers;
    std::vector<Migration<Dim>>& out;  ///< by link
    [[nodiscard]] Migration<Dim>& message_of(std::int32_t row) const {
      return out[static_cast<std::size_t>(leavers.of(row))];
    }
    [[nodiscard]] std::int32_t number_of(std::int32_t row) const {
      return leavers.number[static_cast<std::size_t>(row)];
    }
  };

  void keep_staying(const PairBlock& block, const Way& way);
  void loosen(const PairList& list, std::size_t k, std::array<std::int32_t, 2> ends, bool counts,
              const Way& way);
  void collect_walls(const Way& way);
  void put_back_kept(std::span<const std::int32_t> new_row);
  void put_back_loose(std::span<const std::int32_t> new_row);
  void put_back_walls(std::span<const std::int32_t> new_row);
  bool place(std::int32_t a, std::int32_t b, const double* history);
  void put(const PairPlace& at, bool is_swapped, const double* history) const;
  [[nodiscard]] std::int32_t find_near(std::int32_t row, std::int64_t id) const;
  [[nodiscard]] bool may_hold(std::int32_t a, std::int32_t b) const;

  Brick<Dim>& brick_;
  HistoryTable<std::array<std::int32_t, 2>> kept_;  ///< by source rows
  HistoryTable<LooseContact> loose_;
  std::vector<WallContact<Dim>> walls_;
  LinkCounts imbalance_;
  Loss loss_ = Loss::Nothing;
};

extern template class HistoryCarry<2>;
extern template class HistoryCarry<3>;

}  // namespace barchan
