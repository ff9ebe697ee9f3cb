#include <string>

#include <barchan/core/kernels/kernel_set.hpp>
#include <barchan/core/particles/layout.hpp>

#include "peak.hpp"
#include "suites.hpp"

// What the machine can do: a triad a = b + s·c over arrays of growing size, and arithmetic in
// registers.

namespace barchan::micro {
namespace {

Triad widest_triad() {
#ifdef BARCHAN_HAS_X86_KERNELS
  if (vector_widths().back() == VectorWidth::Avx512) return &triad_avx512;
  if (vector_widths().back() == VectorWidth::Avx2) return &triad_avx2;
#endif
  return &triad_scalar;
}

void triad(benchmark::State& state) {
  const std::int64_t n = state.range(0) * 1024 / (3 * 64) * 8;
  const auto size = static_cast<std::size_t>(n);
  AlignedVector<double> a(size, 0.0), b(size, 1.0), c(size, 2.0);
  const Triad run = widest_triad();
  for (auto _ : state) {
    run(a.data(), b.data(), c.data(), n);
    benchmark::ClobberMemory();
  }
  report(state, static_cast<double>(n), {24.0, 24.0, 2.0});
}

void peak(benchmark::State& state, double (*run)(std::int64_t), int width) {
  constexpr std::int64_t kRounds = 100000;
  for (auto _ : state) benchmark::DoNotOptimize(run(kRounds));
  report(state, static_cast<double>(kRounds) * kChains * width, {0.0, 0.0, 2.0});
}

}  // namespace

void add_limits() {
  benchmark::RegisterBenchmark("limit/triad_KiB", triad)
      ->Arg(24)
      ->Arg(512)
      ->Arg(8 << 10)
      ->Arg(256 << 10);
  for (const VectorWidth width : vector_widths()) {
    auto* run = &peak_scalar;
#ifdef BARCHAN_HAS_X86_KERNELS
    if (width == VectorWidth::Avx2) run = &peak_avx2;
    if (width == VectorWidth::Avx512) run = &peak_avx512;
#endif
    const int lanes = static_cast<int>(width);
    benchmark::RegisterBenchmark(("limit/flops/" + name_of(width)).c_str(),
                                 [run, lanes](benchmark::State& s) { peak(s, run, lanes); });
  }
}

}  // namespace barchan::micro
