#include <benchmark/benchmark.h>

#include "suites.hpp"

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  barchan::micro::add_limits();
  barchan::micro::add_kernels();
  barchan::micro::add_rebuild();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
