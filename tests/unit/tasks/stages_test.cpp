#include <barchan/tasks/stages.hpp>

#include <gtest/gtest.h>

namespace barchan {
namespace {

/// Ten steps of settling, then a stage that ends when it is at rest.
Model two_stages() {
  Model model;
  model.time.step = 0.1;
  model.stages.resize(2);
  model.stages[0].max_time = 1.0;
  model.stages[1].kinetic_ratio = 1e-3;
  return model;
}

TEST(Stages, EndWhenTheirTimeIsOver) {
  const Model model = two_stages();
  const Stages stages(model);

  EXPECT_FALSE(stages.may_end(9));
  EXPECT_TRUE(stages.may_end(10));
  EXPECT_TRUE(stages.time_is_over(10));
  EXPECT_FALSE(stages.is_last());
}

TEST(Stages, AreLookedAtNowAndThenWhereTheyEndAtRest) {
  const Model model = two_stages();
  Stages stages(model);

  stages.enter_next(10);

  EXPECT_TRUE(stages.is_last());
  EXPECT_TRUE(stages.begins_at(10));
  EXPECT_FALSE(stages.may_end(10));   // nothing has moved yet
  EXPECT_FALSE(stages.may_end(100));  // steps count from the stage's begin
  EXPECT_TRUE(stages.may_end(110));
  EXPECT_FALSE(stages.time_is_over(1'000'000));
}

TEST(Stages, GoOnFromACheckpoint) {
  const Model model = two_stages();
  Stages before(model), after(model);
  before.enter_next(10);

  CheckpointState state;
  before.save(state);
  after.restore(state);

  EXPECT_EQ(after.current(), 1);
  EXPECT_TRUE(after.begins_at(10));
}

}  // namespace
}  // namespace barchan
