#include <barchan/core/brick/prefetch.hpp>

#include <algorithm>
#include <array>

namespace barchan {
namespace {

/// A brick with more than this does not stay in the third cache from step to step; a smaller one
/// is slower by a tenth where it prefetches.
constexpr std::size_t kPrefetchBytes = std::size_t{22} << 20;

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

void prefetch_front(const PairList& list, const PairBlock& block) {
  const std::int64_t k = block.begin, count = block.num_packed;
  prefetch_values(list.packed_i.data() + k, count);
  prefetch_values(list.packed_j.data() + k, count);
  prefetch_values(list.packed_code.data() + k, count);
  prefetch_values(list.history.data() + k * list.history_length, count * list.history_length);
}

template <int Dim>
void prefetch(const ParticleStore<Dim>& store, Rows rows) {
  using L = Layout<Dim>;
  keep_calls();
  for (std::int32_t i = rows.begin; i < rows.end; ++i) {
    const auto at = static_cast<std::size_t>(i);
    __builtin_prefetch(store.motion.data() + at * L::kMotion);
    __builtin_prefetch(store.force.data() + at * L::kForce, 1);
    if constexpr (Dim == 3) __builtin_prefetch(store.spin.data() + at * L::kSpin);
  }
}

/// What a step reads and writes.
template <int Dim>
std::size_t working_set(const Brick<Dim>& brick) {
  std::size_t total = brick.store.bytes() + brick.pairs.bytes();
  for (const Band& band : brick.bands) total += band.across.bytes();
  return total;
}

}  // namespace

template <int Dim>
void plan_prefetch(Brick<Dim>& brick) {
  const World<Dim>& world = *brick.world;
  brick.prefetches = world.packs() && working_set(brick) > kPrefetchBytes;
  if (!brick.prefetches) return;
  const std::int64_t line = world.grid.cells(Dim - 1);
  const std::array<std::int64_t, 2> reach{world.grid.slab_size() + line + 1, line + 1};
  // Of a rim, whose rows come first, nothing is prefetched.
  const std::int32_t n = brick.store.num_owned, rim = brick.num_rim;
  const auto keys = brick.store.key.begin();
  std::array<std::int32_t, 2> met{rim, rim};
  RowBlock* before = nullptr;
  for (RowBlock& block : brick.blocks) {
    if (block.begin == block.end) continue;
    const std::int32_t last =
        std::min(brick.pairs.i[static_cast<std::size_t>(block.end - 1)], n - 1);
    if (last < rim) continue;
    const std::int64_t key = brick.store.key[static_cast<std::size_t>(last)];
    for (std::size_t edge = 0; edge < 2; ++edge) {
      const auto to_come = static_cast<std::int32_t>(
          std::upper_bound(keys + met[edge], keys + n, key + reach[edge]) - keys);
      if (before != nullptr) before->to_come[edge] = {met[edge], to_come};
      met[edge] = to_come;
    }
    before = &block;
  }
}

template <int Dim>
void run_with_prefetch(const Brick<Dim>& brick, const RowBlock& block, const PairJob& pairs) {
  const RowBlock* next = &block + 1;
  if (next < brick.blocks.data() + brick.blocks.size() && next->is_packed)
    prefetch_front(brick.pairs, *next);
  for (int part = 0; part < kParts; ++part) {
    for (const Rows rows : block.to_come) prefetch(brick.store, part_of(rows, part));
    brick.world->kernels.pairs(part_of(pairs, part));
  }
}

template void plan_prefetch(Brick<2>&);
template void plan_prefetch(Brick<3>&);
template void run_with_prefetch(const Brick<2>&, const RowBlock&, const PairJob&);
template void run_with_prefetch(const Brick<3>&, const RowBlock&, const PairJob&);

}  // namespace barchan
