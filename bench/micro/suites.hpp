#pragma once

#include <benchmark/benchmark.h>

namespace barchan::micro {

/// What one item of a benchmark costs in principle.
struct ItemCost {
  double bytes = 0.0;        ///< that must come from or go to memory where no cache holds them
  double cache_bytes = 0.0;  ///< that instructions load and store
  double flops = 0.0;        ///< additions, multiplications, divisions and roots
};

/// Sets the counters that bench/micro/micro makes its table of.
inline void report(benchmark::State& state, double items, const ItemCost& cost) {
  state.counters["items"] = items;
  state.counters["item_rate"] =
      benchmark::Counter(items, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["bytes"] = cost.bytes;
  state.counters["cache_bytes"] = cost.cache_bytes;
  state.counters["flops"] = cost.flops;
}

void add_limits();   ///< bandwidth by size of the data, arithmetic by width of vectors
void add_kernels();  ///< pairs, rows, whole steps, halo records
void add_rebuild();  ///< order, candidates, history

}  // namespace barchan::micro
