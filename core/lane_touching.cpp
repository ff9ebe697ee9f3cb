#include <algorithm>
#include <cmath>

#include <barchan/core/lane.hpp>

// Where many candidates do not touch, a block works only on those that touch or soon may. A narrow
// phase finds them, and packs their pairs, laws and springs to the front of the block. The packed
// pairs serve until particles may have moved far enough for another pair to touch. A pair that
// parts meanwhile has no force and loses its spring, as it would in the whole list.
//
//   candidates   | a b c d e f g h | …        springs, unpacked   | a – c – – f g – |
//   mask         | 1 0 1 0 0 1 1 0 |          springs, packed     | a c f g | …

namespace barchan {
namespace {

template <int Dim>
void copy_spring(const double* from, std::int64_t k, double* to, std::int64_t a) {
  constexpr int kSprings = Layout<Dim>::kSprings;
  const double* s = from + k / kBatch * kBatch * kSprings + k % kBatch;
  double* t = to + a / kBatch * kBatch * kSprings + a % kBatch;
  for (int c = 0; c < kSprings; ++c) t[c * kBatch] = s[c * kBatch];
}

template <int Dim>
void clear_spring(double* to, std::int64_t a) {
  double* t = to + a / kBatch * kBatch * Layout<Dim>::kSprings + a % kBatch;
  for (int c = 0; c < Layout<Dim>::kSprings; ++c) t[c * kBatch] = 0.0;
}

/// The springs of a block, component by component, and room for one pair more.
template <int Dim>
struct BlockSprings {
  static constexpr int kSprings = Layout<Dim>::kSprings, kRoom = kBlockPairs + kBatch;
  alignas(64) double value[kSprings][kRoom];

  void read(const double* springs, std::int64_t count) {
    for (std::int64_t k = 0; k < count; k += kBatch) {
      for (int c = 0; c < kSprings; ++c)
        std::copy_n(springs + k * kSprings + c * kBatch, int{kBatch}, value[c] + k);
    }
  }
  void write(double* springs, std::int64_t count) const {
    for (std::int64_t k = 0; k < count; k += kBatch) {
      for (int c = 0; c < kSprings; ++c)
        std::copy_n(value[c] + k, int{kBatch}, springs + k * kSprings + c * kBatch);
    }
  }
  std::int64_t clear(std::int64_t k) {
    for (auto& component : value) component[k] = 0.0;
    return k;
  }
  void copy(std::int64_t to, const BlockSprings& other, std::int64_t from) {
    for (int c = 0; c < kSprings; ++c) value[c][to] = other.value[c][from];
  }
};

bool has_bit(const std::uint8_t* masks, std::int64_t k) {
  return (masks[k / 8] >> (k % 8) & 1) != 0;
}

template <int Dim>
void unpack(PairList& list, PairBlock& block) {
  if (!block.is_packed) return;
  double* springs = list.template springs_of_block<Dim>(block.begin);
  const std::uint8_t* known = list.mask.data() + block.begin / kBatch;
  std::int64_t a = block.num_packed;
  for (std::int64_t k = block.end - block.begin - 1; k >= 0; --k) {
    if (has_bit(known, k))
      copy_spring<Dim>(springs, --a, springs, k);
    else
      clear_spring<Dim>(springs, k);
  }
  block.is_packed = false;
}

}  // namespace

// A narrow margin asks for the narrow phase often, a wide one lets more pairs in that do not touch.
// With n steps between two narrow phases, the costs go with n·travel/skin and 1/n, so the best
// margin n·travel is about sqrt(skin·travel), where travel is that of one step.
template <int Dim>
double Lane<Dim>::packing_margin() const {
  return std::sqrt(world_->skin * step_travel_);
}

template <int Dim>
PairJob Lane<Dim>::block_job(PairList& list, PairBlock& block, double travel) {
  PairJob pairs = job(list);
  pairs.begin = block.begin;
  pairs.end = block.end;
  if (packs()) pick_touching(list, block, pairs, travel);
  return pairs;
}

template <int Dim>
void Lane<Dim>::pick_touching(PairList& list, PairBlock& block, PairJob& pairs, double travel) {
  if (!block.is_packed || travel > block.packed_until) {
    std::array<std::uint8_t, kBlockPairs / kBatch> masks;
    const double margin = packing_margin();
    world_->kernels.narrow(pairs, margin, masks.data());
    pack(list, block, masks.data());
    // Both of a pair travel; a little less, for the rounding of positions and sums.
    block.packed_until = travel + 0.499 * margin;
  }
  pairs.i = list.packed_i.data();
  pairs.j = list.packed_j.data();
  pairs.code = list.packed_code.data();
  pairs.end = block.begin + (block.num_packed + kBatch - 1) / kBatch * kBatch;
}

// Nobody can foretell which lane of which batch is set, so nothing here branches on it.
template <int Dim>
void Lane<Dim>::pack(PairList& list, PairBlock& block, const std::uint8_t* masks) {
  std::uint8_t* known = list.mask.data() + block.begin / kBatch;
  double* springs = list.template springs_of_block<Dim>(block.begin);
  const std::int64_t size = block.end - block.begin;
  if (!block.is_packed) std::fill_n(known, size / kBatch, std::uint8_t{0xff});
  const std::int64_t num_before = block.is_packed ? block.num_packed : size;
  BlockSprings<Dim> before, after;
  before.read(springs, num_before);
  const std::int64_t none = before.clear(num_before);
  const auto first = static_cast<std::size_t>(block.begin);
  std::int64_t old = 0, now = 0;
  for (std::int64_t k = 0; k < size; ++k) {
    const bool was = has_bit(known, k);
    const auto from = first + static_cast<std::size_t>(k),
               to = first + static_cast<std::size_t>(now);
    list.packed_i[to] = list.i[from];
    list.packed_j[to] = list.j[from];
    list.packed_code[to] = list.code[from];
    after.copy(now, before, was ? old : none);
    now += has_bit(masks, k) ? 1 : 0;
    old += was ? 1 : 0;
  }
  block.num_packed = now;
  for (; now % kBatch != 0; ++now) {
    const auto to = first + static_cast<std::size_t>(now);
    list.packed_i[to] = store_.waste();
    list.packed_j[to] = store_.waste() + 1;
    list.packed_code[to] = 0;
    after.clear(now);
  }
  after.write(springs, now);
  std::copy_n(masks, size / kBatch, known);
  block.is_packed = true;
}

template <int Dim>
void Lane<Dim>::unpack_history() {
  for (Block& block : blocks_) unpack<Dim>(pairs_, block);
  for (const Side side : {Left, Right}) unpack_history_across(side);
}

template <int Dim>
void Lane<Dim>::unpack_history_across(Side side) {
  for (PairBlock& block : bands_[side].blocks) unpack<Dim>(bands_[side].across, block);
}

template class Lane<2>;
template class Lane<3>;

}  // namespace barchan
