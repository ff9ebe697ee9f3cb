#include <barchan/tasks/rebuild_schedule.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "support/mpi_session.hpp"

namespace barchan {
namespace {

constexpr double kSkin = 0.02, kDt = 1e-3;
constexpr int kLook = 16;

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
  RebuildSchedule schedule(Communicator(test::world()), kSkin, kDt, gravity, kLook);
  schedule.begin(0, course.speed);
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
  // Growth that doubles the speed in the longest span of the rule.
  for (const double v : {0.01, 0.1, 0.5}) {
    const double span = (RebuildSchedule::kLag + kLook) * kDt;
    int rebuilds = 0;
    const double most = farthest({v / span, v}, 0.0, 150, rebuilds);
    EXPECT_LE(most, 0.5 * kSkin) << "first speed " << v;
  }
}

TEST(RebuildSchedule, NoStepIsComputedBeyondHalfTheSkinHoweverFastParticlesAre) {
  for (const double v : {1.0, 3.0, 9.0, 50.0, 1000.0}) {
    int rebuilds = 0;
    const double most = farthest({0.0, v}, 0.0, 150, rebuilds);
    EXPECT_LE(most, 0.5 * kSkin) << "speed " << v;
    EXPECT_GT(rebuilds, 10);
  }
}

TEST(RebuildSchedule, AnswersComeInTimeSoThatListsServeForHalfTheSkin) {
  constexpr int kSteps = 2000;
  for (const double speed : {0.1, 0.2, 0.3}) {
    int rebuilds = 0;

    EXPECT_LE(farthest({0.0, speed}, 0.0, kSteps, rebuilds), 0.5 * kSkin);

    EXPECT_LE(rebuilds, 1.08 * kSteps * speed * kDt / (0.5 * kSkin)) << speed;
  }
}

TEST(RebuildSchedule, FastParticlesHaveNewListsInEveryStepAndSlowOnesAgainTheirOldOnes) {
  RebuildSchedule schedule(Communicator(test::world()), kSkin, kDt, 0.0, kLook);
  schedule.begin(0, 50.0);
  std::array<int, 2> rebuilds{};
  for (std::int64_t step = 0; step < 200; ++step) {
    const bool is_fast = step < 100;
    if (schedule.must_rebuild(step)) {
      schedule.rebuilt(step);
      ++rebuilds[is_fast ? 0 : 1];
    }
    if (schedule.is_check_due(step)) schedule.begin_check(travel_of(0.0, is_fast ? 50.0 : 0.0), {});
  }
  EXPECT_EQ(rebuilds[0], 99);  // all but step 0, whose lists are those of the start
  EXPECT_LE(rebuilds[1], RebuildSchedule::kLag + RebuildSchedule::kCheckEvery);
}

TEST(RebuildSchedule, ListsServeAsLongAsTheRuleSays) {
  constexpr double kGravity = 9.81;
  const RebuildSchedule schedule(Communicator(test::world()), kSkin, kDt, kGravity, kLook);
  for (const std::int64_t heard : {100, 97}) {
    for (const double speed : {0.0, 0.01, 0.1, 0.5, 4.0, 20.0}) {
      for (const double distance : {0.0, 0.3 * kSkin, 0.49 * kSkin}) {
        const auto travel = [&](double n) {
          const double t = (static_cast<double>(100 - heard) + n) * kDt;
          return distance + (2.0 * speed + kGravity * t) * n * kDt;
        };
        const auto n =
            static_cast<double>(schedule.end_of_lists(100, distance, speed, heard) - 101);
        ASSERT_GE(n, 0.0);
        EXPECT_LE(travel(n), 0.5 * kSkin);
        EXPECT_GT(travel(n + 1.0), 0.5 * kSkin);
      }
    }
  }
}

TEST(RebuildSchedule, ChecksComeSeldomWhileNothingMovesAndEveryLookHasOne) {
  RebuildSchedule schedule(Communicator(test::world()), kSkin, kDt, 0.0, kLook);
  int checks = 0;
  for (std::int64_t step = 0; step < 20 * kLook; ++step) {
    ASSERT_FALSE(schedule.must_rebuild(step));
    if (step % 7 == 0) schedule.rebuilt(step);  // for reasons of somebody else
    ASSERT_TRUE(!schedule.is_look(step) || schedule.is_check_due(step)) << "step " << step;
    if (!schedule.is_check_due(step)) continue;
    schedule.begin_check(travel_of(0.0, 0.0), {});
    ++checks;
  }
  EXPECT_LE(checks, 20 * kLook / 3);
}

TEST(RebuildSchedule, EveryLookHasItsCheckHoweverLateAnswersAre) {
  for (const int lag : {2, 6, 10, 16}) {
    RebuildSchedule schedule(Communicator(test::world()), kSkin, kDt, 0.0, kLook, lag);
    schedule.begin(0, 0.0);
    int rebuilds = 0;
    double moved = 0.0;
    for (std::int64_t step = 0; step < 1000; ++step) {
      if (schedule.must_rebuild(step)) {
        ASSERT_LE(moved, 0.5 * kSkin) << "lag " << lag << ", step " << step;
        schedule.rebuilt(step);
        moved = 0.0;
        ++rebuilds;
      }
      EXPECT_TRUE(step % kLook != 0 || schedule.is_check_due(step))
          << "lag " << lag << ": " << step;
      if (schedule.is_check_due(step)) schedule.begin_check(travel_of(moved, 0.3), {});
      moved += 0.3 * kDt;
    }
    EXPECT_GT(rebuilds, 10);
  }
}

TEST(RebuildSchedule, AnAnswerThatIsOverdueAfterARestartIsTakenAtOnce) {
  RebuildSchedule schedule(Communicator(test::world()), kSkin, kDt, 0.0, kLook);
  schedule.restore(23, 0.0, {16, 5, 0.5}, 100);  // another run's answers came 10 steps later

  EXPECT_FALSE(schedule.must_rebuild(23));
  ASSERT_TRUE(schedule.take_answer());
  EXPECT_FALSE(schedule.must_rebuild(24));
  EXPECT_FALSE(schedule.take_answer());
}

TEST(RebuildSchedule, HoldsWhatACheckFoundAgainstTheSkinThatItsListsHad) {
  RebuildSchedule schedule(Communicator(test::world()), kSkin, kDt, 0.0, kLook);
  schedule.begin_check(travel_of(0.4 * kSkin, 0.0), {});
  schedule.set_skin(0.5 * kSkin);
  schedule.rebuilt(1);

  EXPECT_FALSE(schedule.must_rebuild(RebuildSchedule::kLag));
  EXPECT_LE(schedule.take_answer()->distance, 0.25 * kSkin);
}

TEST(RebuildSchedule, ALookIsAnsweredThoughListsAreMadeAnewMeanwhile) {
  RebuildSchedule schedule(Communicator(test::world()), kSkin, kDt, 0.0, kLook);
  schedule.begin_check({kSkin, 0.0, 17, 0.25, 1, {}}, {});
  schedule.rebuilt(1);

  EXPECT_EQ(schedule.pending_look(2).outside, 17);
  EXPECT_FALSE(schedule.must_rebuild(RebuildSchedule::kLag)) << "its distance is of the old lists";
  EXPECT_EQ(schedule.take_answer()->outside, 17);
}

TEST(RebuildSchedule, GoesOnFromACheckpointWithTheLookThatWasPending) {
  RebuildSchedule schedule(Communicator(test::world()), kSkin, kDt, 0.0, kLook);
  schedule.restore(17, 0.0, {16, 5, 0.5}, 100);

  EXPECT_FALSE(schedule.must_rebuild(17));
  EXPECT_FALSE(schedule.must_rebuild(18));
  const auto answer = schedule.take_answer();

  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->outside, 5);
  EXPECT_EQ(answer->overlap, 0.5);
  EXPECT_EQ(answer->particles, 100);
}

TEST(RebuildSchedule, ForeseesOnALoneRankWhatItWillDecide) {
  RebuildSchedule schedule(Communicator(test::world()), kSkin, kDt, 0.0, kLook);
  int rebuilds = 0, goes = 0;
  for (std::int64_t step = 0; step < 2000; ++step) {
    if (schedule.must_rebuild(step)) {
      schedule.rebuilt(step);
      ++rebuilds;
    }
    if (!schedule.is_check_due(step)) continue;
    const double way = kSkin * static_cast<double>(step * 7919 % 1000) / 1800.0;
    schedule.begin_check(travel_of(way, 0.2), {});
    const auto foreseen = schedule.foresee();
    if (!foreseen) continue;

    ASSERT_FALSE(schedule.must_rebuild(step + RebuildSchedule::kLag));

    ASSERT_EQ(foreseen->answer.distance, way);
    ASSERT_TRUE(schedule.is_check_due(foreseen->next_check));
    ASSERT_EQ(schedule.next_part(step + 1), foreseen->next_check) << "lists last until then";
    step = foreseen->next_check - 1;
    ++goes;
  }
  EXPECT_GT(rebuilds, 10);
  EXPECT_GT(goes, 10);
}

TEST(RebuildSchedule, ForeseesNothingWhereSomebodyHasAWish) {
  for (const bool stop : {false, true}) {
    RebuildSchedule schedule(Communicator(test::world()), kSkin, kDt, 0.0, kLook);
    schedule.begin_check(travel_of(0.0, 0.0), {stop, !stop});
    EXPECT_FALSE(schedule.foresee());
    EXPECT_FALSE(schedule.must_rebuild(RebuildSchedule::kLag));
    EXPECT_EQ(schedule.take_stop_agreed(), stop);
  }
}

TEST(RebuildSchedule, TellsOnceWhatACheckFound) {
  RebuildSchedule schedule(Communicator(test::world()), kSkin, kDt, 0.0, kLook);
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
  RebuildSchedule schedule(Communicator(test::world()), kSkin, kDt, 0.0, kLook);
  schedule.begin_check(travel_of(std::numeric_limits<double>::quiet_NaN(), 0.0), {});

  EXPECT_TRUE(schedule.must_rebuild(RebuildSchedule::kLag));
  EXPECT_TRUE(std::isnan(schedule.take_answer()->distance));
}

}  // namespace
}  // namespace barchan
