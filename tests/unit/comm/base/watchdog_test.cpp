#include <barchan/comm/base/watchdog.hpp>

#include <string>

#include <gtest/gtest.h>

#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

TEST(Watchdog, WaitsUntilThePollIsTrue) {
  int num_polls = 0;

  wait_until([&] { return ++num_polls == 1000; }, [] { return "nothing"; });

  EXPECT_EQ(num_polls, 1000);
}

TEST(Watchdog, SaysWhatWasWaitedForWhenTheLimitIsOver) {
  try {
    wait_until([] { return false; },
               [] { return "rank 2: halo message of step 17 from rank 1 (left)"; }, 0.02);
    FAIL() << "waited for ever";
  } catch (const RunError& error) {
    EXPECT_NE(std::string(error.what()).find("rank 2: halo message of step 17 from rank 1 (left)"),
              std::string::npos);
    EXPECT_NE(std::string(error.what()).find("BARCHAN_WAIT_LIMIT"), std::string::npos);
  }
}

TEST(Watchdog, TakesOnlyPositiveLimits) {
  const double before = wait_limit();

  EXPECT_THROW(set_wait_limit(0.0), InputError);
  EXPECT_THROW(set_wait_limit(-1.0), InputError);
  set_wait_limit(5.0);
  EXPECT_EQ(wait_limit(), 5.0);
  set_wait_limit(before);
}

}  // namespace
}  // namespace barchan
