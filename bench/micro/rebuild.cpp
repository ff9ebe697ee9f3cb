#include <array>
#include <chrono>
#include <string>
#include <vector>

#include "sample.hpp"
#include "suites.hpp"

// Rebuilds of one lane, part by part: each benchmark does the whole rebuild and counts the time of
// its part.

namespace barchan::micro {
namespace {

enum Part { Leave, Order, Candidates, History, Chunks, kParts, Whole = kParts };
constexpr std::array<const char*, kParts + 1> kNames{"leave",   "order",  "candidates",
                                                     "history", "chunks", "whole"};

using Seconds = std::array<double, kParts + 1>;

template <int Dim>
Seconds rebuild(Lane<Dim>& lane) {
  using Clock = std::chrono::steady_clock;
  Seconds seconds{};
  auto last = Clock::now();
  const auto lap = [&](Part part) {
    const auto now = Clock::now();
    seconds[part] = std::chrono::duration<double>(now - last).count();
    seconds[Whole] += seconds[part];
    last = now;
  };
  lane.rebuild.begin({lane.brick.box, {}}, {});
  lap(Leave);
  lane.rebuild.order();
  lap(Order);
  lane.lists.list_owned();
  lane.rebuild.take_ghosts({});
  lap(Candidates);
  lane.rebuild.restore_history();
  lap(History);
  lane.lists.cut_chunks(1 << 14);
  lap(Chunks);
  return seconds;
}

/// Least traffic per particle: what a part reads and writes at least once.
template <int Dim>
ItemCost least(Part part, double pairs_each) {
  const double record = (Dim == 2 ? 64.0 : 96.0) + 18.0,
               spring = 8.0 * LinearSpring::kHistory<Dim>.length;
  ItemCost cost;
  if (part == Order || part == Whole) cost.bytes += 2.0 * record;
  if (part == Candidates || part == Whole) cost.bytes += 64.0 + pairs_each * (9.0 + spring);
  if (part == History || part == Whole) cost.bytes += pairs_each * (16.0 + 2.0 * spring);
  if (part == Leave || part == Whole) cost.bytes += 64.0 + pairs_each * (8.0 + spring);
  cost.cache_bytes = cost.bytes;
  return cost;
}

template <int Dim>
void part_of_rebuild(benchmark::State& state, Part part) {
  const auto sample = make_sample<Dim>(state.range(0), vector_widths().back());
  Lane<Dim>& lane = *sample->lane;
  step(lane);  // history to carry
  for (auto _ : state) state.SetIterationTime(rebuild(lane)[part]);
  const auto n = static_cast<double>(state.range(0));
  report(state, n, least<Dim>(part, static_cast<double>(lane.brick.num_pairs()) / n));
  state.counters["candidates_each"] = static_cast<double>(lane.brick.num_pairs()) / n;
}

template <int Dim>
void add(std::int64_t small) {
  for (int p = 0; p <= Whole; ++p) {
    const auto part = static_cast<Part>(p);
    const std::string name =
        std::string("rebuild_") + kNames[static_cast<std::size_t>(p)] + (Dim == 2 ? "_2d" : "_3d");
    benchmark::RegisterBenchmark(name.c_str(),
                                 [part](benchmark::State& s) { part_of_rebuild<Dim>(s, part); })
        ->Arg(small)
        ->Arg(200000)
        ->Iterations(20)  // of whole rebuilds: parts of microseconds would ask for thousands
        ->UseManualTime();
  }
}

}  // namespace

void add_rebuild() {
  add<2>(5000);
  add<3>(30000);
}

}  // namespace barchan::micro
