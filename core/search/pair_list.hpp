#pragma once

#include <algorithm>
#include <cstdint>
#include <type_traits>

#include <barchan/core/laws/history.hpp>
#include <barchan/core/particles/layout.hpp>

namespace barchan {

/// Pairs that are worked on in one go: a block's rows stay in the first cache.
inline constexpr std::int64_t kBlockPairs = 32 * kBatch;

/// Candidate pairs, sorted by both rows, with their law and history; whole batches, padded with
/// waste rows.
struct PairList {
  AlignedVector<std::int32_t> i, j;  ///< rows of each pair
  AlignedVector<std::uint8_t> code;  ///< law of each pair
  AlignedVector<double> history;     ///< per batch of eight: number by number
  int history_length = 0;            ///< numbers per pair (laws/history.hpp)

  // Pairs of each block that touch or nearly do, packed to its front (brick/packing.hpp); empty
  // where every candidate is worked on.
  AlignedVector<std::int32_t> packed_i, packed_j;
  AlignedVector<std::uint8_t> packed_code, mask;

  [[nodiscard]] std::int64_t size() const { return static_cast<std::int64_t>(i.size()); }
  void clear() {
    i.clear();
    j.clear();
    code.clear();
  }
  void push(std::int32_t a, std::int32_t b, std::uint8_t law) {
    i.push_back(a);
    j.push_back(b);
    code.push_back(law);
  }
  /// Makes it at least n long, with pairs that are any.
  void make_room(std::int64_t n) {
    if (n <= size()) return;
    const auto room = std::max(static_cast<std::size_t>(n + n / 2), i.capacity());
    for (auto* column : {&i, &j}) column->resize(room);
    code.resize(room);
  }
  void shorten(std::int64_t n) {
    for (auto* column : {&i, &j}) column->resize(static_cast<std::size_t>(n));
    code.resize(static_cast<std::size_t>(n));
  }
  void prepare_packing() {
    for (auto* column : {&packed_i, &packed_j}) resize_with_room(*column, i.size());
    resize_with_room(packed_code, i.size());
    resize_with_room(mask, i.size() / kBatch);
  }
  /// Fills the last batch; the null law and radius zero make the padding harmless.
  void pad(std::int32_t waste) {
    while (size() % kBatch != 0) push(waste, waste + 1, 0);
  }
  /// Gives memory back where pushing has left much more than is needed.
  void trim() {
    const auto fit = [](auto& column) {
      if (column.capacity() < column.size() + column.size() / 8) return;
      std::remove_reference_t<decltype(column)> fitting;
      fitting.reserve(column.size() + column.size() / 16);
      fitting.assign(column.begin(), column.end());
      column.swap(fitting);
    };
    fit(i);
    fit(j);
    fit(code);
  }
  void reset_history(int length) {
    history_length = length;
    resize_with_room(history, i.size() * static_cast<std::size_t>(length));
    std::fill(history.begin(), history.end(), 0.0);
  }
  [[nodiscard]] double* history_of(std::int64_t k) {  ///< number c at [c·kBatch]
    return history.data() + k / kBatch * kBatch * history_length + k % kBatch;
  }
  [[nodiscard]] const double* history_of(std::int64_t k) const {
    return const_cast<PairList*>(this)->history_of(k);
  }
  /// In a block that is packed: whether the pair is.
  [[nodiscard]] bool is_packed(std::int64_t k) const {
    return (mask[static_cast<std::size_t>(k / kBatch)] >> (k % kBatch) & 1) != 0;
  }
  [[nodiscard]] double* history_of_block(std::int64_t begin) {
    return history.data() + begin * history_length;
  }
  /// Some number is not zero: the contact is kept.
  [[nodiscard]] bool has_history(std::int64_t k) const { return has_history(k, history_length); }
  /// @param length  the same, known when it is compiled
  template <class Length>
  [[nodiscard]] bool has_history(std::int64_t k, Length length) const {
    const double* numbers = history.data() + k / kBatch * kBatch * length + k % kBatch;
    bool has_any = false;
    for (int c = 0; c < length; ++c) has_any = has_any | (numbers[c * kBatch] != 0.0);
    return has_any;
  }
  [[nodiscard]] std::size_t bytes() const {
    return 4 * (i.capacity() + j.capacity() + packed_i.capacity() + packed_j.capacity()) +
           code.capacity() + packed_code.capacity() + mask.capacity() + 8 * history.capacity();
  }
};

/// Pairs [begin, end) of a list, and those of them that are worked on.
struct PairBlock {
  std::int64_t begin = 0, end = 0;
  std::int64_t num_packed = 0;
  bool is_packed = false;  ///< works on pairs that touch or nearly do, packed to its front
  double packed_until =
      0.0;  ///< mean travel of the two of a pair up to which no other can touch [m]

  [[nodiscard]] std::int64_t num_worked_on() const { return is_packed ? num_packed : end - begin; }
  /// Calls f(k, numbers) for all pairs of the block with their history, number c at [c·kBatch],
  /// wherever it is.
  template <class F>
  void for_each_candidate(const PairList& list, F&& f) const {
    static constexpr double kNone[kMostHistory * kBatch] = {};
    std::int64_t packed = begin;
    for (std::int64_t k = begin; k < end; ++k) {
      const bool has_place = !is_packed || list.is_packed(k);
      f(static_cast<std::size_t>(k), has_place ? list.history_of(is_packed ? packed : k) : kNone);
      packed += has_place ? 1 : 0;
    }
  }
  /// Calls f(k, i, j) for the pairs that have a result.
  template <class F>
  void for_each_worked_on(const PairList& list, F&& f) const {
    const auto& first = is_packed ? list.packed_i : list.i;
    const auto& second = is_packed ? list.packed_j : list.j;
    const std::int64_t last = begin + num_worked_on();
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(last); ++k)
      f(k, first[k], second[k]);
  }
};

}  // namespace barchan
