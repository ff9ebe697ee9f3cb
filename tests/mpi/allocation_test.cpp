// Counts what is allocated in the whole program, MPI and TBB included, by standing in for malloc.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "scenarios.hpp"

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define BARCHAN_COUNTS_MALLOC 1
#endif

namespace {

std::atomic<bool> g_counts{false};
std::atomic<long> g_num_new{0}, g_num_malloc{0};

void* allocate(std::size_t bytes, std::size_t alignment) {
  if (g_counts) ++g_num_new;
  void* memory = nullptr;
  if (alignment <= alignof(std::max_align_t))
    memory = std::malloc(bytes);
  else if (posix_memalign(&memory, alignment, bytes) != 0)
    memory = nullptr;
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

// Ours, and what the standard library does for us.
void* operator new(std::size_t bytes) {
  return allocate(bytes, 1);
}
void* operator new(std::size_t bytes, const std::nothrow_t& /*tag*/) noexcept {
  if (g_counts) ++g_num_new;
  return std::malloc(bytes);
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return allocate(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t /*bytes*/) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t /*alignment*/) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t /*bytes*/, std::align_val_t /*alignment*/) noexcept {
  std::free(memory);
}

#ifdef BARCHAN_COUNTS_MALLOC
// Everybody's.
extern "C" void* __libc_malloc(std::size_t bytes);
extern "C" void* malloc(std::size_t bytes) noexcept {
  if (g_counts) ++g_num_malloc;
  return __libc_malloc(bytes);
}
#endif

namespace barchan::test {
namespace {

struct Allocations {
  long by_new = 0, by_malloc = 0;  ///< the first are among the second
  int steps = 0;
};

/// Of the steps that rebuild nothing, among `num_steps`.
Allocations in_steady_steps(Simulation& sim, int num_steps) {
  Allocations sum;
  for (int n = 0; n < num_steps; ++n) {
    const std::int64_t rebuilds = sim.timings().rebuilds;
    g_num_new = g_num_malloc = 0;
    g_counts = true;
    sim.run(1);
    g_counts = false;
    if (sim.timings().rebuilds != rebuilds) continue;
    sum.by_new += g_num_new;
    sum.by_malloc += g_num_malloc;
    ++sum.steps;
  }
  return sum;
}

class SteadyStep : public testing::TestWithParam<std::string> {};

TEST_P(SteadyStep, AllocatesNothing) {
  for (const bool is_loaded : {false, true}) {
    Scenario s = is_loaded ? soil_with_ring_and_plate() : moving_walls();
    if (is_loaded) s.model.stages = {Stage{"settle", 1e-3, 1e6}, Stage{"load", 0.1}};
    for (const int threads : {1, 2}) {
      RunOptions options;
      options.exchange = GetParam();
      options.threads = threads;
      Simulation sim(s.model, s.set, MPI_COMM_WORLD, options);
      sim.run(200);  // all buffers have grown

      const Allocations found = in_steady_steps(sim, 100);

      EXPECT_GT(found.steps, 50);
      EXPECT_EQ(found.by_new, 0) << GetParam() << ", " << threads << " threads, " << s.name;
      // Open MPI allocates for every MPI_Rget, now and then where its lists of requests grow, and
      // for a post that comes while this rank may not yet start towards that one: a window serves
      // the links of one number, so a rank in the middle starts on one towards both sides.
      if (GetParam() != "get") {
        EXPECT_LT(found.by_malloc, GetParam() == "pscw" ? 3 * found.steps : 10)
            << GetParam() << ", " << threads << " threads, " << s.name;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Of, SteadyStep,
                         testing::Values("shared", "put-inband", "put-flag", "get", "pscw", "isend",
                                         "fence", "sendrecv", "return"),
                         [](const auto& param) {
                           std::string name = param.param;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace barchan::test
