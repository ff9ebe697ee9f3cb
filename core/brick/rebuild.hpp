#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

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

  /// Owns these particles and bonds. @pre they lie in the slabs
  void seed(int slab_begin, int slab_end, std::span<const ParticleData> particles,
            std::span<const BondData> bonds, std::span<const double> bond_lengths,
            std::span<const char> is_bonded);
  /// Owns so many rows, which the caller fills.
  void own(int slab_begin, int slab_end, std::int32_t count);

  /// These particles, of any brick, go in the next rebuild, with their contacts and bonds.
  /// @param ids  ascending. @return how many of those this brick counts
  LinkCounts remove(std::span<const std::int64_t> ids);

  /// Takes slabs [slab_begin, slab_end) from now on; writes who leaves, with history and bonds.
  void begin(int slab_begin, int slab_end, std::vector<std::byte>& to_left,
             std::vector<std::byte>& to_right);
  void absorb(std::span<const std::byte> message);  ///< arrivals. Errors: RunError: damaged
  /// Those of a caller that lie in the slabs; between begin and order.
  void take_in(std::span<const ParticleData> newcomers);
  void order();  ///< by cells
  void pack_ghosts(Side side, std::vector<std::byte>& message) const;
  /// Lists pairs with them, too. Errors: RunError: damaged
  void take_ghosts(std::span<const std::byte> left, std::span<const std::byte> right);
  void restore_history();

  [[nodiscard]] std::int64_t num_leaving() const {
    return std::count_if(leavers_.way.begin(), leavers_.way.end(), [](auto way) {
      return way == Leavers::ToLeft || way == Leavers::ToRight;
    });
  }
  HistoryCarry<Dim>& carry() { return carry_; }
  [[nodiscard]] const HistoryCarry<Dim>& carry() const { return carry_; }
  [[nodiscard]] std::size_t bytes() const {
    return carry_.bytes() + sizeof(std::int32_t) * new_row_.capacity();
  }

 private:
  [[nodiscard]] Leavers::Way way_of(std::int64_t key, std::int64_t key_before) const;
  void find_leavers(std::array<Migration<Dim>, 2>& out);
  void collect_bonds(std::array<Migration<Dim>, 2>& out);
  [[nodiscard]] bool computes_bond(std::int32_t bond) const;
  [[nodiscard]] std::pair<bool, bool> bond_leaves(std::int32_t bond) const;
  std::vector<std::int32_t> sources();

  Brick<Dim>& brick_;
  Lists<Dim>& lists_;
  HistoryCarry<Dim> carry_;
  // between begin and restore_history
  Leavers leavers_;                    ///< by source row: this brick's, then arrivals
  std::vector<std::int32_t> new_row_;  ///< of every source row; -1: left
};

extern template class Rebuild<2>;
extern template class Rebuild<3>;

}  // namespace barchan
