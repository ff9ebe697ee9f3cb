#include <barchan/tasks/rebuild_schedule.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/mpi_session.hpp"

namespace barchan {
namespace {

constexpr double kSkin = 0.02, kDt = 1e-3;

CheckNumbers travel_of(double distance, double speed) {
  CheckNumbers mine;
  mine.distance = distance;
  mine.speed = speed;
  return mine;
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

TEST(RebuildSchedule, ForeseesOnALoneRankWhatItWillDecide) {
  RebuildSchedule schedule(Communicator(test::world()), kSkin, kDt, 0.0);
  int rebuilds = 0, goes = 0;
  for (std::int64_t step = 0; step < 2000; ++step) {
    if (!schedule.is_check_due(step)) continue;
    const double way = kSkin * static_cast<double>(step * 7919 % 1000) / 1800.0;
    schedule.begin_check(travel_of(way, 0.2), {});
    const auto foreseen = schedule.foresee();
    const std::int64_t answer_at = schedule.next_part(step);
    ASSERT_EQ(answer_at, step + RebuildSchedule::kLag);

    const bool must_rebuild = schedule.must_rebuild(answer_at);

    ASSERT_EQ(foreseen.has_value(), !must_rebuild);
    if (must_rebuild) {
      schedule.rebuilt(answer_at);
      ++rebuilds;
    } else {
      ASSERT_EQ(foreseen->answer.distance, way);
      ASSERT_TRUE(schedule.is_check_due(foreseen->next_check));
      ASSERT_EQ(schedule.next_part(answer_at - 1), foreseen->next_check);
      ++goes;
    }
  }
  EXPECT_GT(rebuilds, 10);
  EXPECT_GT(goes, 10);
}

TEST(RebuildSchedule, ForeseesNothingWhereSomebodyHasAWish) {
  for (const bool stop : {false, true}) {
    RebuildSchedule schedule(Communicator(test::world()), kSkin, kDt, 0.0);
    schedule.begin_check(travel_of(0.0, 0.0), {stop, !stop});
    EXPECT_FALSE(schedule.foresee());
    EXPECT_FALSE(schedule.must_rebuild(RebuildSchedule::kLag));
    EXPECT_EQ(schedule.take_stop_agreed(), stop);
  }
}

TEST(RebuildSchedule, TellsOnceWhatACheckFound) {
  RebuildSchedule schedule(Communicator(test::world()), kSkin, kDt, 0.0);
  schedule.begin_check({0.5, 2.0, 17, 0.25, 100, {1, -2, 3}}, {});
  EXPECT_FALSE(schedule.take_answer());

  EXPECT_TRUE(schedule.must_rebuild(RebuildSchedule::kLag));
  const auto answer = schedule.take_answer();

  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->distance, 0.5);
  EXPECT_EQ(answer->speed, 2.0);
  EXPECT_EQ(answer->outside, 17);
  EXPECT_EQ(answer->overlap, 0.25);
  EXPECT_EQ(answer->particles, 100);
  EXPECT_EQ(answer->imbalance.contacts, 1);
  EXPECT_EQ(answer->imbalance.wall_contacts, -2);
  EXPECT_EQ(answer->imbalance.bonds, 3);
  EXPECT_FALSE(schedule.take_answer());
}

TEST(RebuildSchedule, AStateThatIsNotFiniteIsNeverTakenForOneAtRest) {
  RebuildSchedule schedule(Communicator(test::world()), kSkin, kDt, 0.0);
  schedule.begin_check(travel_of(std::numeric_limits<double>::quiet_NaN(), 0.0), {});

  EXPECT_TRUE(schedule.must_rebuild(RebuildSchedule::kLag));
  EXPECT_TRUE(std::isnan(schedule.take_answer()->distance));
}

}  // namespace
}  // namespace barchan
