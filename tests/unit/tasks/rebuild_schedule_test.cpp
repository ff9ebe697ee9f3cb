#include <barchan/tasks/rebuild_schedule.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <barchan/core/error.hpp>

#include "support/mpi_session.hpp"

namespace barchan {
namespace {

constexpr double kSkin = 0.02, kDt = 1e-3;

Travel travel_of(double distance, double speed) {
  return {distance * distance, speed * speed, 0};
}

/// What a particle does on a line: speeds by step, as fast as the rule allows for.
struct Course {
  double acceleration;
  double speed = 0.0, distance = 0.0;
  void step() {
    speed += acceleration * kDt;
    distance += speed * kDt;
  }
};

/// Runs a schedule against a course. @return the largest distance that any step was computed with
double farthest(Course course, double gravity, int num_steps, int& rebuilds) {
  RebuildSchedule schedule(Communicator(test::world()), kSkin, kDt, gravity);
  double most = 0.0;
  rebuilds = 0;
  for (std::int64_t step = 0; step < num_steps; ++step) {
    if (schedule.must_rebuild(step)) {
      course.distance = 0.0;
      schedule.rebuilt(step);
      ++rebuilds;
    }
    if (schedule.is_check_due(step))
      schedule.begin_check(travel_of(course.distance, course.speed), {});
    schedule.poll();
    most = std::max(most, course.distance);
    course.step();
  }
  return most;
}

TEST(RebuildSchedule, NoStepIsComputedBeyondHalfTheSkinInFreeFall) {
  for (const double g : {9.81, 30.0, 100.0}) {
    int rebuilds = 0;
    const double most = farthest({g}, g, static_cast<int>(2500.0 / g), rebuilds);  // up to 2.5 m/s
    EXPECT_LE(most, 0.5 * kSkin) << "gravity " << g;
    EXPECT_GT(rebuilds, 0);
  }
}

TEST(RebuildSchedule, NoStepIsComputedBeyondHalfTheSkinWhileSpeedsAtMostDoubleBetweenAnswers) {
  // Growth that doubles the speed in the longest span of the rule, 2·kLag + kLongest steps.
  for (const double v : {0.01, 0.1, 0.5}) {
    const double span = (2 * RebuildSchedule::kLag + RebuildSchedule::kLongest) * kDt;
    int rebuilds = 0;
    const double most = farthest({v / span, v}, 0.0, 150, rebuilds);
    EXPECT_LE(most, 0.5 * kSkin) << "first speed " << v;
  }
}

TEST(RebuildSchedule, ItsIntervalBoundsTheDistanceAtTheNextAnswer) {
  for (int last = 0; last <= RebuildSchedule::kLongest; ++last) {
    for (const double speed : {0.0, 0.01, 0.1, 0.5, 1.0}) {
      for (const double distance : {0.0, 0.3 * kSkin, 0.49 * kSkin}) {
        const int n = RebuildSchedule::next_interval(distance, speed, kSkin, kDt, 9.81, last);
        ASSERT_LE(n, std::clamp(2 * last, 1, RebuildSchedule::kLongest));
        if (n < 0) continue;
        const double t = (2 * RebuildSchedule::kLag + n) * kDt;
        EXPECT_LE(distance + 2.0 * speed * t + 9.81 * t * t, 0.5 * kSkin);
      }
    }
  }
}

TEST(RebuildSchedule, IntervalsGrowWhileNothingMoves) {
  int interval = 0, steps = 0;
  for (; interval < RebuildSchedule::kLongest && steps < 10; ++steps) {
    interval = RebuildSchedule::next_interval(0.0, 0.0, kSkin, kDt, 0.0, interval);
  }
  EXPECT_EQ(interval, RebuildSchedule::kLongest);
  EXPECT_LE(steps, 5);
}

TEST(RebuildSchedule, RefusesToGoOnWhenAParticleOutranTheSkin) {
  RebuildSchedule schedule(Communicator(test::world()), kSkin, kDt, 0.0);
  schedule.begin_check(travel_of(0.51 * kSkin, 1.0), {});
  EXPECT_THROW((void)schedule.must_rebuild(RebuildSchedule::kLag), RunError);
}

TEST(RebuildSchedule, RefusesAStateThatIsNotFiniteOrOutside) {
  for (const Travel t :
       {Travel{std::numeric_limits<double>::quiet_NaN(), 0.0, 0},
        Travel{0.0, std::numeric_limits<double>::infinity(), 0}, Travel{0.0, 0.0, 17}}) {
    RebuildSchedule schedule(Communicator(test::world()), kSkin, kDt, 0.0);
    schedule.begin_check(t, {});
    EXPECT_THROW((void)schedule.must_rebuild(RebuildSchedule::kLag), RunError);
  }
}

}  // namespace
}  // namespace barchan
