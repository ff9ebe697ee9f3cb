#pragma once

#include <cstddef>
#include <cstdint>

#include <barchan/core/brick/brick.hpp>
#include <barchan/core/kernels/history_table.hpp>
#include <barchan/core/search/contact_search.hpp>

namespace barchan {

/// Seconds of contact search, by the phase that it is part of.
struct SearchSeconds {
  double rebuild = 0.0;
  double chunks = 0.0, bands = 0.0;  ///< all-pairs searches anew in every step
};

/// A pair's place in a list. list == nullptr: it is not listed.
struct PairPlace {
  PairList* list = nullptr;
  std::int64_t k = -1;
};
/// Of two owned rows, low < high. @pre row_begin
template <int Dim>
[[nodiscard]] PairPlace owned_place(Brick<Dim>& brick, std::int32_t low, std::int32_t high);
/// Of two rows, of which one may be a ghost.
template <int Dim>
[[nodiscard]] PairPlace place_of(Brick<Dim>& brick, std::int32_t a, std::int32_t b);

/// Makes the candidate lists of a brick, and the blocks and chunks in which a step walks over them.
template <int Dim>
class Lists {
 public:
  explicit Lists(Brick<Dim>& brick) : brick_(brick) {}

  /// Which pairs hold a bond that is not broken; they are no contacts.
  void list_bonded();
  /// Owned pairs. @pre rows ordered by cells
  void list_owned();
  /// Pairs across a cut. @pre ghosts
  void list_across(Side side);
  /// @param chunk_pairs  pairs per chunk of the step; any number gives the same bits
  void cut_chunks(std::int64_t chunk_pairs);

  // All-pairs search finds candidates anew in every step; contacts keep their history.
  void search_owned_again();
  void search_across_again(Side side);

  [[nodiscard]] const SearchSeconds& seconds() const { return seconds_; }
  void restart_seconds() { seconds_ = {}; }
  [[nodiscard]] std::size_t bytes() const { return planes_.bytes() + kept_.bytes(); }

 private:
  using KeptContacts = HistoryTable<std::array<std::int32_t, 2>>;

  void find_owned();
  void find_across(Side side);
  void cut_blocks();
  [[nodiscard]] SearchRule rule() const;
  static void keep(const PairList& list, KeptContacts& to);
  void put_back(PairList& list, const KeptContacts& kept) const;

  Brick<Dim>& brick_;
  Planes planes_;
  KeptContacts kept_;  ///< while owned pairs are searched again
  SearchSeconds seconds_;
};

extern template class Lists<2>;
extern template class Lists<3>;

}  // namespace barchan
