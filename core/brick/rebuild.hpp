#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <barchan/core/base/bytes.hpp>
#include <barchan/core/brick/brick.hpp>
#include <barchan/core/brick/history_carry.hpp>
#include <barchan/core/brick/lists.hpp>

namespace barchan {

/// Who owns which particles, and in which order: the rebuild of a brick, in this order.
///
///   begin, absorb, order, pack_ghosts · Lists::list_owned · take_ghosts, restore_history
///   · Lists::cut_chunks
///
/// At the start of a run `seed`, or restore (checkpoint.hpp), takes the place of begin and absorb.
template <int Dim>
class Rebuild {
 public:
  Rebuild(Brick<Dim>& brick, Lists<Dim>& lists) : brick_(brick), lists_(lists), carry_(brick) {}

  /// Owns these particles and bonds. @pre they lie in the box
  void seed(const Placement<Dim>& at, std::span<const ParticleData> particles,
            std::span<const BondData> bonds, std::span<const double> bond_lengths,
            std::span<const char> is_bonded);
  /// Owns so many rows, which the caller fills.
  void own(const Placement<Dim>& at, std::int32_t count);

  /// These particles, of any brick, go in the next rebuild, with their contacts and bonds.
  /// @param ids  ascending. @return how many of those this brick counts
  LinkCounts remove(std::span<const std::int64_t> ids);

  /// Lies there from now on; writes who leaves, with history and bonds.
  /// @param out  by link; replaced. Errors: RunError: a particle is farther off than any link leads
  void begin(const Placement<Dim>& at, std::span<std::vector<std::byte>> out);
  void absorb(std::span<const std::byte> message);  ///< arrivals. Errors: RunError: damaged
  /// Those of a caller that lie in the box; between begin and order.
  void take_in(std::span<const ParticleData> newcomers);
  void order();  ///< by cells
  void pack_ghosts(int link, std::vector<std::byte>& message) const;
  /// Lists pairs with them, too. @param messages  by link. Errors: RunError: damaged
  void take_ghosts(std::span<const std::span<const std::byte>> messages);
  void restore_history();

  // Shadows: slabs beside a cut of strips go to the brick beyond, which steps them, too.
  /// All of these slabs, and the ghosts behind them. Instead of pack_ghosts.
  /// @param depth  how many slabs
  void pack_slabs(int link, int depth, std::vector<std::byte>& message) const;
  /// Becomes a slab that is to be absorbed, from what pack_slabs wrote of it; then order().
  void begin_shadow(const Placement<Dim>& at);

  [[nodiscard]] std::int64_t num_leaving() const {
    return std::count_if(leavers_.way.begin(), leavers_.way.end(),
                         [](auto way) { return way >= 0; });
  }
  HistoryCarry<Dim>& carry() { return carry_; }
  [[nodiscard]] const HistoryCarry<Dim>& carry() const { return carry_; }
  [[nodiscard]] std::size_t bytes() const {
    return carry_.bytes() + sizeof(std::int32_t) * new_row_.capacity();
  }

 private:
  [[nodiscard]] std::int8_t way_of(const CellAt<Dim>& at, std::int64_t id) const;
  void find_leavers(std::vector<Migration<Dim>>& out);
  void collect_bonds(std::vector<Migration<Dim>>& out);
  [[nodiscard]] bool computes_bond(std::int32_t bond) const;

  Brick<Dim>& brick_;
  Lists<Dim>& lists_;
  HistoryCarry<Dim> carry_;
  // between begin and restore_history
  Leavers leavers_;                    ///< by source row: this brick's, then arrivals
  std::vector<std::int32_t> new_row_;  ///< of every source row; -1: left
};

/// What pack_slabs wrote, slab by slab from the cut on, and the ghosts behind them, for
/// take_ghosts. Errors: RunError: damaged
[[nodiscard]] std::vector<std::vector<std::byte>> unpack_slabs(ByteReader& message, int depth);

extern template class Rebuild<2>;
extern template class Rebuild<3>;

}  // namespace barchan
