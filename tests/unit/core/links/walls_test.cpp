#include <barchan/core/links/walls.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace barchan {
namespace {

WallSpec spec_of(WallKind kind, const Vec3& normal, double width = 0.0) {
  WallSpec s;
  s.kind = kind;
  s.normal = normal;
  s.width = width;
  return s;
}

template <int Dim>
ParticleStore<Dim> one_particle(const Vec3& x, double radius) {
  ParticleStore<Dim> s;
  s.num_owned = 1;
  s.resize_for_ghosts();
  s.start_extra(0, s.num_owned);
  for (int c = 0; c < Dim; ++c) s.x(0)[c] = x[c];
  s.x(0)[Layout<Dim>::kRadius] = radius;
  s.x(0)[Layout<Dim>::kInverseMass] = 1.0;
  return s;
}

/// Walls in a box, and one law of stiffness 100 N/m without friction.
struct Setting {
  explicit Setting(std::vector<WallSpec> given, const PeriodicBox& box = {})
      : specs(std::move(given)), states(specs.size()) {
    ContactTable table{1, {ContactConstants{}}, true};
    table.constants[0].kn = 100.0;
    laws = LawTable(table);
    for (const WallSpec& spec : specs) shapes.emplace_back(spec, box);
  }
  [[nodiscard]] WallView<2> view() const { return {specs, shapes, states}; }
  [[nodiscard]] WallContacts<2>::Frame frame() const { return {view(), &laws, 0.01}; }

  std::vector<WallSpec> specs;
  std::vector<WallShape<2>> shapes;
  std::vector<WallState> states;
  LawTable laws;
};

TEST(Walls, PushAlongTheNormalAndCountForceTorqueAndWork) {
  Setting walls({spec_of(WallKind::Plane, {0.0, 1.0, 0.0})});
  walls.states[0].velocity = Vec3(0.0, 2.0, 0.0);
  ParticleStore<2> store = one_particle<2>({2.0, 0.4, 0.0}, 0.5);
  std::vector<WallSums> stepped(1), measured(1);
  WallContacts<2> contacts;
  contacts.search(store, walls.view(), 0.05);

  contacts.add_to_rows(store, walls.frame(), stepped, 0, 1);
  contacts.measure(store, walls.frame(), measured);

  ASSERT_EQ(contacts.list().size(), 1U);
  EXPECT_NEAR(store.e(0)[1], 10.0, 1e-9);
  EXPECT_NEAR(stepped[0].work.value(), 10.0 * 2.0 * 0.01, 1e-9);
  EXPECT_NEAR(measured[0].force[1].value(), -10.0, 1e-9);
  EXPECT_NEAR(measured[0].torque[2].value(), -20.0, 1e-9);
}

TEST(Walls, OnAndBehindAWallThePushGoesOutAndGrowsWithTheDepth) {
  const Setting walls(
      {spec_of(WallKind::Plane, {0.0, 1.0, 0.0}), spec_of(WallKind::Plate, {0.0, 1.0, 0.0}, 8.0)});
  for (const double height : {0.4, 1e-3, 0.0, -0.25, -3.0}) {
    ParticleStore<2> store = one_particle<2>({2.0, height, 0.0}, 0.5);
    std::vector<WallSums> sums(2);
    WallContacts<2> contacts;
    contacts.search(store, walls.view(), 0.05);

    contacts.add_to_rows(store, walls.frame(), sums, 0, 1);

    // A plate has two sides, so a centre beyond it is pushed to the other one.
    const double plate =
        height < 0.0 ? -100.0 * std::max(0.0, 0.5 + height) : 100.0 * (0.5 - height);
    EXPECT_NEAR(store.e(0)[1], 100.0 * (0.5 - height) + plate, 1e-9) << height;
  }
}

TEST(Walls, KeepWhatLoadedPlatesPressForTheRows) {
  WallSpec plate = spec_of(WallKind::Plate, {0.0, -1.0, 0.0}, 2.0);
  plate.is_loaded = true;
  plate.mass = 1.0;
  const Setting walls({spec_of(WallKind::Plane, {0.0, 1.0, 0.0}), plate,
                       spec_of(WallKind::Plane, {1.0, 0.0, 0.0})});
  ParticleStore<2> store = one_particle<2>({0.3, 0.4, 0.0}, 0.5);
  std::vector<WallSums> pressed(3), works(3);
  WallContacts<2> contacts;
  contacts.search(store, walls.view(), 0.05);
  ASSERT_EQ(contacts.list().size(), 3U);

  contacts.press(store, walls.frame(), pressed);
  contacts.add_to_rows(store, walls.frame(), works, 0, 1);

  EXPECT_NEAR(pressed[1].force[1].value(), -10.0, 1e-9);
  EXPECT_EQ(pressed[0].force[1].value(), 0.0);
  EXPECT_NEAR(store.e(0)[0], 20.0, 1e-9);
  EXPECT_NEAR(store.e(0)[1], 20.0, 1e-9);  // the plate stands at the floor: both push
  EXPECT_EQ(works[1].work.value(), 0.0);
}

TEST(Walls, ALoadedPlateIsNotPressedAtItsEndByWhatLiesOnThePlateBesideIt) {
  WallSpec fixed = spec_of(WallKind::Plate, {0.0, 1.0, 0.0}, 2.0), loaded = fixed;
  loaded.is_loaded = true;
  loaded.mass = 1.0;
  for (const double x : {-0.1, 0.1}) {
    Setting walls({fixed, loaded});
    walls.states[0].point = Vec3(-1.0, 0.0, 0.0);
    walls.states[1].point = Vec3(1.0, 0.0, 0.0);
    ParticleStore<2> store = one_particle<2>({x, 0.4, 0.0}, 0.5);
    std::vector<WallSums> pressed(2), works(2);
    WallContacts<2> contacts;
    contacts.search(store, walls.view(), 0.05);
    ASSERT_EQ(contacts.list().size(), 2U);

    contacts.press(store, walls.frame(), pressed);
    contacts.add_to_rows(store, walls.frame(), works, 0, 1);

    EXPECT_NEAR(pressed[1].force[1].value(), x < 0.0 ? 0.0 : -10.0, 1e-9) << x;
    EXPECT_NEAR(store.e(0)[0], 0.0, 1e-9) << x;
    EXPECT_NEAR(store.e(0)[1], 10.0, 1e-9) << x;
  }
}

TEST(Walls, ListOnlyWhatIsNearAndActive) {
  Setting walls(std::vector<WallSpec>(3, spec_of(WallKind::Plane, {0.0, 1.0, 0.0})));
  walls.states[1].is_active = false;
  walls.states[2].point = Vec3(0.0, -1.0, 0.0);
  const ParticleStore<2> store = one_particle<2>({2.0, 0.52, 0.0}, 0.5);
  WallContacts<2> contacts;

  contacts.search(store, walls.view(), 0.05);

  ASSERT_EQ(contacts.list().size(), 1U);
  EXPECT_EQ(contacts.list()[0].wall, 0);
}

TEST(Walls, ListFixedParticlesAtLoadedPlatesOnly) {
  WallSpec plate = spec_of(WallKind::Plate, {0.0, 1.0, 0.0}, 2.0);
  plate.is_loaded = true;
  plate.mass = 1.0;
  const Setting walls({spec_of(WallKind::Plane, {0.0, 1.0, 0.0}), plate});
  ParticleStore<2> store = one_particle<2>({0.0, 0.4, 0.0}, 0.5);
  store.x(0)[Layout<2>::kInverseMass] = 0.0;
  WallContacts<2> contacts;

  contacts.search(store, walls.view(), 0.05);

  ASSERT_EQ(contacts.list().size(), 1U);
  EXPECT_EQ(contacts.list()[0].wall, 1);
}

}  // namespace
}  // namespace barchan
