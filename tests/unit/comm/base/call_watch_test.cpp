#include <barchan/comm/base/call_watch.hpp>

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include <barchan/comm/base/watchdog.hpp>

namespace barchan {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

TEST(CallWatchDeathTest, EndsTheProcessWithTheCallsNameWhenItTakesTooLong) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto hang = [] {
    set_wait_limit(0.2);
    const CallWatch outer("MPI_Patient", 1000.0), inner("MPI_Hanging");
    std::this_thread::sleep_for(60s);
  };
  EXPECT_EXIT(hang(), testing::ExitedWithCode(1),
              "gave up after waiting .* s for a rank: MPI_Hanging");
}

TEST(CallWatch, LetsCallsBeThatEndInTime) {
  const double before = wait_limit();
  set_wait_limit(0.2);
  for (int n = 0; n < 4; ++n) {
    const CallWatch watch("MPI_Quick");
    std::this_thread::sleep_for(100ms);
  }
  set_wait_limit(before);
}

}  // namespace
}  // namespace barchan
