#include <barchan/core/walls.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace barchan {
namespace {

WallSpec spec_of(WallKind kind, const Vec3& normal, double width = 0.0, double depth = 0.0) {
  WallSpec s;
  s.kind = kind;
  s.normal = normal;
  s.width = width;
  s.depth = depth;
  return s;
}

template <int Dim>
void expect_nearest(const WallSpec& spec, const Vec3& point, const Vec3& x, double distance,
                    const Vec3& nearest) {
  WallState state;
  state.point = point;
  double to_wall[3] = {};

  const double d = WallContacts<Dim>::nearest(spec, state, x.data(), to_wall);

  EXPECT_NEAR(d, distance, 1e-12);
  for (int c = 0; c < Dim; ++c)
    EXPECT_NEAR(x[c] + to_wall[c], nearest[c], 1e-8) << "component " << c;
}

TEST(Walls, PlaneIsNearestAtTheFootOfThePerpendicular) {
  const double h = std::sqrt(0.5);
  expect_nearest<2>(spec_of(WallKind::Plane, {0.0, 1.0, 0.0}), {5.0, 1.0, 0.0}, {2.0, 1.25, 0.0},
                    0.25, {2.0, 1.0, 0.0});
  expect_nearest<2>(spec_of(WallKind::Plane, {h, h, 0.0}), {0.0, 0.0, 0.0}, {1.0, 1.0, 0.0},
                    2.0 * h, {0.0, 0.0, 0.0});
  expect_nearest<3>(spec_of(WallKind::Plane, {0.0, 0.0, -1.0}), {0.0, 0.0, 3.0}, {1.0, 2.0, 2.5},
                    0.5, {1.0, 2.0, 3.0});
}

TEST(Walls, DeepBehindAPlaneThePushStillGoesOut) {
  const WallSpec spec = spec_of(WallKind::Plane, {0.0, 1.0, 0.0});
  const double x[3] = {0.0, -0.4, 0.0};
  double to_wall[3] = {};

  EXPECT_NEAR(WallContacts<2>::nearest(spec, WallState(), x, to_wall), -0.4, 1e-15);
  EXPECT_LT(to_wall[1],
            0.0);  // from the particle into the wall, so that the force points along the normal
}

TEST(Walls, PlateIn2DIsASegment) {
  const WallSpec plate = spec_of(WallKind::Plate, {0.0, -1.0, 0.0}, 2.0);
  const Vec3 middle(5.0, 3.0, 0.0);
  expect_nearest<2>(plate, middle, {5.5, 2.0, 0.0}, 1.0, {5.5, 3.0, 0.0});  // below its face
  expect_nearest<2>(plate, middle, {4.5, 3.5, 0.0}, 0.5,
                    {4.5, 3.0, 0.0});  // above: touched from either side
  expect_nearest<2>(plate, middle, {9.0, 3.0, 0.0}, 3.0, {6.0, 3.0, 0.0});  // in its line
  expect_nearest<2>(plate, middle, {6.3, 2.6, 0.0}, 0.5, {6.0, 3.0, 0.0});  // at its right edge
  expect_nearest<2>(plate, middle, {3.6, 3.3, 0.0}, 0.5, {4.0, 3.0, 0.0});  // at its left edge
}

TEST(Walls, PlateIn3DIsARectangle) {
  // Width along x: the axis least aligned with the normal comes first.
  const WallSpec plate = spec_of(WallKind::Plate, {0.0, 0.0, 1.0}, 2.0, 4.0);
  const Vec3 middle(0.0, 0.0, 1.0);
  expect_nearest<3>(plate, middle, {0.5, 1.5, 1.5}, 0.5, {0.5, 1.5, 1.0});
  expect_nearest<3>(plate, middle, {1.3, 0.5, 1.4}, 0.5, {1.0, 0.5, 1.0});  // an edge
  expect_nearest<3>(plate, middle, {-0.2, -2.3, 0.6}, 0.5,
                    {-0.2, -2.0, 1.0});  // another, from below
  expect_nearest<3>(plate, middle, {1.0 + 2.0, 2.0 + 2.0, 1.0 + 1.0}, 3.0,
                    {1.0, 2.0, 1.0});  // a corner
}

template <int Dim>
ParticleStore<Dim> one_particle(const Vec3& x, double radius) {
  ParticleStore<Dim> s;
  s.num_owned = 1;
  s.resize_for_ghosts();
  for (int c = 0; c < Dim; ++c) s.x(0)[c] = x[c];
  s.x(0)[Layout<Dim>::kRadius] = radius;
  s.x(0)[Layout<Dim>::kInverseMass] = 1.0;
  return s;
}

TEST(Walls, PushAlongTheNormalAndCountForceTorqueAndWork) {
  ContactTable table{1, {ContactConstants{}}, true};
  table.constants[0].kn = 100.0;
  const LawTable laws(table);
  ParticleStore<2> store = one_particle<2>({2.0, 0.4, 0.0}, 0.5);
  const std::vector<WallSpec> specs{spec_of(WallKind::Plane, {0.0, 1.0, 0.0})};
  std::vector<WallState> states(1);
  states[0].velocity = Vec3(0.0, 2.0, 0.0);
  std::vector<WallSums> stepped(1), measured(1);
  WallContacts<2> contacts;
  contacts.search(store, specs, states, 0.05);

  contacts.add_to_rows(store, {specs, states, &laws, 0.01}, stepped, 0, 1);
  contacts.measure(store, {specs, states, &laws, 0.01}, measured);

  ASSERT_EQ(contacts.list().size(), 1U);
  EXPECT_NEAR(store.f(0)[1], 10.0, 1e-9);
  EXPECT_NEAR(stepped[0].force[1].value(), -10.0, 1e-9);
  EXPECT_NEAR(stepped[0].work.value(), 10.0 * 2.0 * 0.01, 1e-9);
  EXPECT_NEAR(measured[0].force[1].value(), -10.0, 1e-9);
  EXPECT_NEAR(measured[0].torque[2].value(), -20.0, 1e-9);
}

TEST(Walls, ListOnlyWhatIsNearAndActive) {
  const ParticleStore<2> store = one_particle<2>({2.0, 0.52, 0.0}, 0.5);
  const std::vector<WallSpec> specs(3, spec_of(WallKind::Plane, {0.0, 1.0, 0.0}));
  std::vector<WallState> states(3);
  states[1].is_active = false;
  states[2].point = Vec3(0.0, -1.0, 0.0);
  WallContacts<2> contacts;

  contacts.search(store, specs, states, 0.05);

  ASSERT_EQ(contacts.list().size(), 1U);
  EXPECT_EQ(contacts.list()[0].wall, 0);
}

}  // namespace
}  // namespace barchan
