#include <algorithm>
#include <array>

#include <barchan/core/brick/lane.hpp>

// Where a lane is larger than the third cache, a step streams all of it from memory. What a block
// needs is prefetched while the block before it is worked on:
//
//   rows    | met already … | first met in the next block | …      one slab on, from memory
//           | met already … | first met again             | …      one line of cells on
//   lists   | this block    | the front of the next block | …
//
// A row is met for the first time by the rows one slab before it, and a slab's work later, when it
// has left the second cache, by the rows one line of cells before it. Both edges follow from the
// cells alone. Pairs around an end of a periodic box, a few, are not prefetched.

namespace barchan {
namespace {

/// A lane with more than this does not stay in the third cache from step to step; a smaller one
/// is slower by a tenth where it prefetches.
constexpr std::size_t kPrefetchBytes = std::size_t{24} << 20;

/// Requests are spread over a block in so many parts: only some can be under way at a time.
constexpr int kParts = 4;

constexpr std::size_t kLine = 64;  ///< bytes of a cache line

Rows part_of(Rows rows, int part) {
  const std::int32_t n = rows.end - rows.begin;
  return {rows.begin + n * part / kParts, rows.begin + n * (part + 1) / kParts};
}

PairJob part_of(PairJob pairs, int part) {
  const std::int64_t batches = (pairs.end - pairs.begin) / kBatch, begin = pairs.begin;
  pairs.begin = begin + batches * part / kParts * kBatch;
  pairs.end = begin + batches * (part + 1) / kParts * kBatch;
  return pairs;
}

/// Without this GCC takes a function that only prefetches for one without effect, and leaves calls
/// of it out.
[[gnu::always_inline]] inline void keep_calls() {
  asm volatile("");
}

template <class T>
void prefetch_values(const T* begin, std::int64_t count) {
  keep_calls();
  const auto* bytes = reinterpret_cast<const char*>(begin);
  const std::size_t size = static_cast<std::size_t>(count) * sizeof(T);
  for (std::size_t at = 0; at < size; at += kLine) __builtin_prefetch(bytes + at);
}

template <int Dim>
void prefetch_front(const PairList& list, const PairBlock& block) {
  const std::int64_t k = block.begin, count = block.num_packed;
  prefetch_values(list.packed_i.data() + k, count);
  prefetch_values(list.packed_j.data() + k, count);
  prefetch_values(list.packed_code.data() + k, count);
  prefetch_values(list.history.data() + k * list.history_length, count * list.history_length);
}

}  // namespace

template <int Dim>
void Lane<Dim>::plan_prefetch() {
  prefetches_ = packs() && bytes() > kPrefetchBytes;
  if (!prefetches_) return;
  const std::int64_t line = world_->grid.cells(Dim - 1);
  const std::array<std::int64_t, 2> reach{world_->grid.slab_size() + line + 1, line + 1};
  const auto num_cells = static_cast<std::int64_t>(cells_.start.size()) - 1;
  std::array<std::int32_t, 2> met{};
  Block* before = nullptr;
  for (Block& block : blocks_) {
    if (block.begin == block.end) continue;
    const std::int32_t last =
        std::min(pairs_.i[static_cast<std::size_t>(block.end - 1)], store_.num_owned - 1);
    const std::int64_t cell = store_.key[static_cast<std::size_t>(last)] - cells_.first_key;
    for (std::size_t edge = 0; edge < 2; ++edge) {
      const std::int64_t end = std::min(cell + reach[edge] + 1, num_cells);
      const std::int32_t to_come = cells_.start[static_cast<std::size_t>(end)];
      if (before != nullptr) before->to_come[edge] = {met[edge], to_come};
      met[edge] = to_come;
    }
    before = &block;
  }
}

template <int Dim>
void Lane<Dim>::run_with_prefetch(const Block& block, const PairJob& pairs) const {
  const Block* next = &block + 1;
  if (next < blocks_.data() + blocks_.size() && next->is_packed) prefetch_front<Dim>(pairs_, *next);
  for (int part = 0; part < kParts; ++part) {
    for (const Rows rows : block.to_come) prefetch(part_of(rows, part));
    world_->kernels.pairs(part_of(pairs, part));
  }
}

template <int Dim>
void Lane<Dim>::prefetch(Rows rows) const {
  keep_calls();
  for (std::int32_t i = rows.begin; i < rows.end; ++i) {
    const auto at = static_cast<std::size_t>(i);
    __builtin_prefetch(store_.motion.data() + at * L::kMotion);
    __builtin_prefetch(store_.force.data() + at * L::kForce, 1);
    if constexpr (Dim == 3) __builtin_prefetch(store_.spin.data() + at * L::kSpin);
  }
}

template class Lane<2>;
template class Lane<3>;

}  // namespace barchan
