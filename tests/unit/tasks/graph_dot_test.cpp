#include <barchan/tasks/graph_dot.hpp>

#include <gtest/gtest.h>

namespace barchan {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Of the middle one of three ranks.
GraphShape two_lanes() {
  const LaneMap map({CutForm::Strips, {3, 1, 1}, {2, 1, 1}}, {});
  GraphShape shape = graph_shape(CutForm::Strips, map.ties(1));
  shape.lanes[0].num_chunks = 3;
  return shape;
}

TEST(GraphDot, LeadsEveryLaneFromItsChunksOverItsBandsToTheEnd) {
  const std::string dot = cluster_of(two_lanes(), 1);

  EXPECT_TRUE(has(dot, "r1_begin -> r1_chunks0;"));
  EXPECT_TRUE(has(dot, "r1_chunks1 -> r1_left1;"));
  EXPECT_TRUE(has(dot, "r1_left1 -> r1_right1;"));
  EXPECT_TRUE(has(dot, "r1_right1 -> r1_end;"));
  EXPECT_TRUE(has(dot, "3 chunks"));
  EXPECT_TRUE(has(dot, "1 chunk\\n"));
}

TEST(GraphDot, LetsMessagesReachTheLanesAtTheEndsOfTheStripOnly) {
  const std::string dot = cluster_of(two_lanes(), 1);

  EXPECT_TRUE(has(dot, "r1_arrived0 -> r1_left0;"));
  EXPECT_TRUE(has(dot, "r1_arrived1 -> r1_right1;"));
  EXPECT_FALSE(has(dot, "r1_arrived0 -> r1_left1;"));
  EXPECT_TRUE(has(dot, "halo from rank 2 is in"));
}

TEST(GraphDot, DrawsTheCutBetweenLanesAsAnEdgeIntoTheNextStep) {
  const std::string dot = cluster_of(two_lanes(), 1);

  EXPECT_TRUE(has(dot, "r1_right0 -> r1_left1 [color=\"#888888\", constraint=false"));
  EXPECT_TRUE(has(dot, "r1_left1 -> r1_right0 [color=\"#888888\", constraint=false"));
}

TEST(GraphDot, HasNoArrivalWhereThereIsNoNeighbour) {
  const LaneMap map({CutForm::Strips, {1, 1, 1}, {2, 1, 1}}, {});

  EXPECT_FALSE(has(cluster_of(graph_shape(CutForm::Strips, map.ties(0)), 0), "arrived"));
}

TEST(GraphDot, WaitsForMessagesBeforeTheFirstChunkWhenSequential) {
  GraphShape shape = two_lanes();
  shape.is_sequential = true;

  const std::string dot = cluster_of(shape, 0);

  EXPECT_TRUE(has(dot, "r0_begin -> r0_await;"));
  EXPECT_TRUE(has(dot, "r0_await -> r0_chunks1;"));
  EXPECT_FALSE(has(dot, "r0_chunks0 -> r0_arrived"));
}

}  // namespace
}  // namespace barchan
