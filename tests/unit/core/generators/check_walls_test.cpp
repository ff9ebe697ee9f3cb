#include <barchan/core/generators/check_walls.hpp>

#include <gtest/gtest.h>

#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

Model model_of(double size) {
  Model model;
  model.domain.hi = Vec3(size, size, 0);
  model.domain.periodic = {true, false, false};
  model.deck_file = "deck.toml";
  model.materials = {{"soil", 126.0}};
  model.stages = {Stage{}, Stage{"later"}};
  return model;
}

/// A wall in a box of 2 by 2 that wraps along x, and a particle of radius 0.05.
std::string refusal_at(const Vec3& position, const WallSpec& wall, bool is_fixed = false) {
  Model model = model_of(2.0);
  model.walls = {wall};
  ParticleSet set;
  set.particles = {{9, 0, 0.05, 1, position, Vec3::Zero(), Vec3::Zero(), is_fixed}};
  try {
    check_walls(model, set);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

WallSpec wall_of(WallKind kind, const Vec3& point) {
  WallSpec wall;
  wall.name = "p";
  wall.kind = kind;
  wall.point = point;
  wall.normal = Vec3(0, 1, 0);
  wall.width = 1.0;
  wall.mass = 1.0;
  return wall;
}

TEST(CheckWalls, RefusesCentresOnOrBehindWalls) {
  const WallSpec plate = wall_of(WallKind::Plate, {1, 1, 0}),
                 floor = wall_of(WallKind::Plane, {0, 1, 0});
  const auto says = [](const std::string& what, const char* words) {
    EXPECT_NE(what.find(words), std::string::npos) << what;
  };
  says(refusal_at({1, 1, 0}, plate), "particle 9 at (1, 1) has its centre on wall 'p'");
  says(refusal_at({0.5, 1, 0}, plate), "centre on wall 'p'");  // its edge
  says(refusal_at({1, 1.01, 0}, plate), "reaches into wall 'p' by 80 % of its radius");
  says(refusal_at({1, 0.99, 0}, plate), "80 %");
  says(refusal_at({1, 1, 0}, floor), "centre on wall 'p'");
  says(refusal_at({1, 0.5, 0}, floor), "centre behind wall 'p'");
  says(refusal_at({0.01, 1, 0}, wall_of(WallKind::Plate, {1.9, 1, 0})), "centre on");  // an image
  EXPECT_EQ(refusal_at({1, 1.03, 0}, plate), "");
  EXPECT_EQ(refusal_at({0.4, 1, 0}, plate), "");
  EXPECT_EQ(refusal_at({1, 0.5, 0}, floor, true), "");  // a fixed bed may be sunk in
}

TEST(CheckWalls, HoldsPlatesOfLaterStagesAgainstFixedParticlesAlone) {
  WallSpec plate = wall_of(WallKind::Plate, {1, 1, 0});
  plate.from_stage = 1;
  EXPECT_EQ(refusal_at({1, 1, 0}, plate), "");
  EXPECT_EQ(refusal_at({1, 1, 0}, plate, true), "");
  plate.is_loaded = true;
  EXPECT_NE(refusal_at({1, 1, 0}, plate, true), "");
}

TEST(CheckWalls, ForetellsWhereAWallWillAppearInParticles) {
  Model model = model_of(10.0);
  model.walls = {wall_of(WallKind::Plate, {5, 5, 0})};
  model.walls[0].from_stage = 1;
  ParticleSet set;
  set.particles = {{1, 0, 0.1, 1, {5, 5, 0}, Vec3::Zero(), Vec3::Zero()},
                   {2, 0, 0.1, 1, {5.3, 5, 0}, Vec3::Zero(), Vec3::Zero()}};

  const auto found = walls_to_come_in_particles(model, set);

  ASSERT_EQ(found.size(), 1U);
  EXPECT_NE(found[0].find("wall 'p' appears with stage 'later'"), std::string::npos) << found[0];
  EXPECT_NE(found[0].find("particle 1 at (5, 5)"), std::string::npos) << found[0];
  EXPECT_NE(found[0].find("and 1 more"), std::string::npos) << found[0];
}

}  // namespace
}  // namespace barchan
