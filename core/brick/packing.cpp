#include <barchan/core/brick/packing.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace barchan {
namespace {

void copy_history(int length, const double* from, std::int64_t k, double* to, std::int64_t a) {
  const double* s = from + k / kBatch * kBatch * length + k % kBatch;
  double* t = to + a / kBatch * kBatch * length + a % kBatch;
  for (int c = 0; c < length; ++c) t[c * kBatch] = s[c * kBatch];
}

void clear_history(int length, double* to, std::int64_t a) {
  double* t = to + a / kBatch * kBatch * length + a % kBatch;
  for (int c = 0; c < length; ++c) t[c * kBatch] = 0.0;
}

/// The histories of a block, number by number, and room for one pair more.
template <class Length>
struct BlockHistory {
  static constexpr int kRoom = kBlockPairs + kBatch;
  alignas(64) double value[kMostHistory][kRoom];
  Length length;  ///< a constant, where a law of the list has it

  explicit BlockHistory(Length of) : length(of) {}

  void read(const double* histories, std::int64_t count) {
    for (std::int64_t k = 0; k < count; k += kBatch) {
      for (int c = 0; c < length; ++c)
        std::copy_n(histories + k * length + c * kBatch, int{kBatch}, value[c] + k);
    }
  }
  void write(double* histories, std::int64_t count) const {
    for (std::int64_t k = 0; k < count; k += kBatch) {
      for (int c = 0; c < length; ++c)
        std::copy_n(value[c] + k, int{kBatch}, histories + k * length + c * kBatch);
    }
  }
  std::int64_t clear(std::int64_t k) {
    for (int c = 0; c < length; ++c) value[c][k] = 0.0;
    return k;
  }
  void copy(std::int64_t to, const BlockHistory& other, std::int64_t from) {
    for (int c = 0; c < length; ++c) value[c][to] = other.value[c][from];
  }
};

bool has_bit(const std::uint8_t* masks, std::int64_t k) {
  return (masks[k / kBatch] >> (k % kBatch) & 1) != 0;
}

// Nobody can foretell which lane of which batch is set, so nothing here branches on it.
template <class Length>
void pack(Length length, PairList& list, PairBlock& block, const std::uint8_t* masks,
          std::int32_t waste) {
  std::uint8_t* known = list.mask.data() + block.begin / kBatch;
  double* histories = list.history_of_block(block.begin);
  const std::int64_t size = block.end - block.begin;
  if (!block.is_packed) std::fill_n(known, size / kBatch, std::uint8_t{0xff});
  const std::int64_t num_before = block.is_packed ? block.num_packed : size;
  BlockHistory<Length> before(length), after(length);
  before.read(histories, num_before);
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
    list.packed_i[to] = waste;
    list.packed_j[to] = waste + 1;
    list.packed_code[to] = 0;
    after.clear(now);
  }
  after.write(histories, now);
  std::copy_n(masks, size / kBatch, known);
  block.is_packed = true;
}

}  // namespace

// A narrow margin asks for the narrow phase often, a wide one lets more pairs in that do not touch.
// With n steps between two narrow phases, the costs go with n·travel/skin and 1/n, so the best
// margin n·travel is about sqrt(skin·travel), where travel is that of one step.
template <int Dim>
void pick_touching(const Brick<Dim>& brick, PairList& list, PairBlock& block, double travel,
                   PairJob& job) {
  if (!block.is_packed || travel > block.packed_until) {
    std::array<std::uint8_t, kBlockPairs / kBatch> masks;
    const double margin = std::sqrt(brick.world->skin * brick.step_travel);
    brick.world->kernels.narrow(job, margin + brick.world->range, masks.data());
    with_length<Dim>(list.history_length, [&](auto length) {
      pack(length, list, block, masks.data(), brick.store.waste());
    });
    // Both of a pair travel; a little less, for the rounding of positions and sums.
    block.packed_until = travel + 0.499 * margin;
  }
  job.i = list.packed_i.data();
  job.j = list.packed_j.data();
  job.code = list.packed_code.data();
  job.end = block.begin + (block.num_packed + kBatch - 1) / kBatch * kBatch;
}

void unpack(PairList& list, PairBlock& block) {
  if (!block.is_packed) return;
  double* histories = list.history_of_block(block.begin);
  const std::uint8_t* known = list.mask.data() + block.begin / kBatch;
  std::int64_t a = block.num_packed;
  for (std::int64_t k = block.end - block.begin - 1; k >= 0; --k) {
    if (has_bit(known, k))
      copy_history(list.history_length, histories, --a, histories, k);
    else
      clear_history(list.history_length, histories, k);
  }
  block.is_packed = false;
}

template void pick_touching(const Brick<2>&, PairList&, PairBlock&, double, PairJob&);
template void pick_touching(const Brick<3>&, PairList&, PairBlock&, double, PairJob&);

}  // namespace barchan
