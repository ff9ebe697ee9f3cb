#include <string>

#include <barchan/core/kernels/kernel_set.hpp>
#include <barchan/core/layout.hpp>

#include "peak.hpp"
#include "suites.hpp"

// What the machine can do: a triad a = b + s·c over arrays of growing size, and arithmetic in
// registers.

namespace barchan::micro {
namespace {

void triad(benchmark::State& state) {
  const auto n = static_cast<std::size_t>(state.range(0)) * 1024 / (3 * sizeof(double));
  AlignedVector<double> a(n, 0.0), b(n, 1.0), c(n, 2.0);
  for (auto _ : state) {
    double* __restrict x = a.data();
    const double* __restrict y = b.data(), * __restrict z = c.data();
    for (std::size_t i = 0; i < n; ++i) x[i] = y[i] + 3.0 * z[i];
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
