#include <barchan/core/brick/messages.hpp>

#include <gtest/gtest.h>

#include <barchan/core/base/bytes.hpp>
#include <barchan/core/base/error.hpp>

#include <unit/core/lane_fixture.hpp>

namespace barchan::test {
namespace {

constexpr int kSlabs = 6;

World<2> world_with_a_wall_and_a_bond() {
  Domain domain;
  domain.hi = Vec3(7.0, 2.4, 0.0);
  World<2> world = world_of<2>(domain, 1.1, 0.1, 20);
  world.bond_laws.resize(1);
  world.walls.resize(1);
  return world;
}

using Store = ParticleStore<2>;

std::int64_t& id(RowRecord<2>& p) {
  return *p.values<&Store::id>();
}
std::int64_t& key(RowRecord<2>& p) {
  return *p.values<&Store::key>();
}

/// A migrant with a contact, a wall and a bond.
Migration<2> a_migration(const World<2>& world) {
  Migration<2> m;
  RowRecord<2> p;
  id(p) = 7;
  p.values<&Store::motion>()[0] = 3.5;
  p.values<&Store::motion>()[1] = 1.2;
  key(p) = world.grid.key(p.values<&Store::motion>());
  *p.values<&Store::type>() = 1;
  m.particles = {p};
  m.contacts = {1, {{0, 9}}, {0.25}};
  m.walls = {{0, 0, {-1, 0, 0}, {0.5}}};
  m.bonds = {{{7, 9, 0, 0.1, {}}, 1}};
  return m;
}

TEST(LaneMessages, BringArrivalsAcrossWithHistoryAndBonds) {
  const World<2> world = world_with_a_wall_and_a_bond();
  std::vector<std::byte> message;
  encode(a_migration(world), message);

  Migration<2> came = decode_migration(message, world, box_of_slabs(world.grid, 0, kSlabs));

  EXPECT_EQ(id(came.particles.at(0)), 7);
  EXPECT_EQ(came.contacts.numbers.at(0), 0.25);
  EXPECT_EQ(came.walls.at(0).history[0], 0.5);
  EXPECT_EQ(came.walls.at(0).image, (WallImage{-1, 0, 0}));
  EXPECT_EQ(came.bonds.at(0).bond.id_b, 9);
}

TEST(LaneMessages, BringFieldsOfCallersWhereARunHasSome) {
  World<2> world = world_with_a_wall_and_a_bond();
  std::vector<std::byte> without, with;
  Migration<2> m = a_migration(world);
  encode(m, without);
  m.carried = {1.5, 2.5};
  encode(m, with);
  const auto decode = [&](const std::vector<std::byte>& message) {
    return decode_migration<2>(message, world, box_of_slabs(world.grid, 0, kSlabs)).carried;
  };

  EXPECT_THROW((void)decode(with), RunError);
  EXPECT_TRUE(decode(without).empty());
  world.num_carried = 2;
  EXPECT_EQ(decode(with), (std::vector<double>{1.5, 2.5}));
  EXPECT_THROW((void)decode(without), RunError);
  world.num_carried = 3;
  EXPECT_THROW((void)decode(with), RunError);
}

TEST(LaneMessages, RefuseWhatWouldLeaveAnArray) {
  const World<2> world = world_with_a_wall_and_a_bond();
  const auto refuses = [&world](auto&& spoil) {
    Migration<2> m = a_migration(world);
    spoil(m);
    std::vector<std::byte> message;
    encode(m, message);
    EXPECT_THROW((void)decode_migration(message, world, box_of_slabs(world.grid, 0, kSlabs)),
                 RunError);
  };
  refuses([](Migration<2>& m) { id(m.particles[0]) = 0; });
  refuses([](Migration<2>& m) { key(m.particles[0]) = -1; });
  refuses([](Migration<2>& m) { key(m.particles[0]) += 1; });
  refuses([](Migration<2>& m) { *m.particles[0].values<&Store::type>() = 2; });
  refuses([](Migration<2>& m) { *m.particles[0].values<&Store::flags>() = 4; });
  refuses([](Migration<2>& m) { m.contacts.rows[0].handle = 1; });
  refuses([](Migration<2>& m) { m.contacts.rows[0].handle = -1; });
  refuses([](Migration<2>& m) { m.contacts.numbers.push_back(0.5); });
  refuses([](Migration<2>& m) { m.contacts.numbers.clear(); });
  refuses([](Migration<2>& m) { m.walls[0].number = 1; });
  refuses([](Migration<2>& m) { m.walls[0].wall = 1; });
  refuses([](Migration<2>& m) { m.walls[0].image[1] = 1 << 30; });
  refuses([](Migration<2>& m) { m.bonds[0].bond.law = 1; });
  refuses([](Migration<2>& m) { m.bonds[0].bond.id_b = 7; });
}

TEST(LaneMessages, RefuseEveryCut) {
  const World<2> world = world_with_a_wall_and_a_bond();
  std::vector<std::byte> message;
  encode(a_migration(world), message);
  for (std::size_t size = 0; size < message.size(); ++size) {
    EXPECT_THROW((void)decode_migration(std::span(message).first(size), world,
                                        box_of_slabs(world.grid, 0, kSlabs)),
                 RunError)
        << size;
  }
  message.emplace_back();
  EXPECT_THROW((void)decode_migration(message, world, box_of_slabs(world.grid, 0, kSlabs)),
               RunError);
}

TEST(LaneMessages, RefuseAParticleOfAnotherBrick) {
  const World<2> world = world_with_a_wall_and_a_bond();
  std::vector<std::byte> message;
  encode(a_migration(world), message);
  try {
    (void)decode_migration(message, world, box_of_slabs(world.grid, 0, 2));
    FAIL();
  } catch (const RunError& e) {
    EXPECT_NE(std::string(e.what()).find("particle 7 belongs to another brick"), std::string::npos);
  }
}

TEST(LaneMessages, RefuseGhostsOutOfOrderOrOfOtherCells) {
  const World<2> world = world_with_a_wall_and_a_bond();
  RowRecord<2> first = a_migration(world).particles[0], second = first;
  id(second) = 8;
  first.values<&Store::motion>()[1] -= 1.0;  // the cell before
  key(first) = world.grid.key(first.values<&Store::motion>());
  ASSERT_GT(key(second), key(first));
  const CellAt<2> at = cell_of_key(world.grid, key(first));
  const auto decode = [&](const std::vector<RowRecord<2>>& ghosts, int of_slab) {
    std::vector<std::byte> message;
    ByteWriter(message).put_counted(ghosts);
    return decode_ghosts(message, world,
                         CellRegion<2>{{{{{of_slab, of_slab}}, {{at[1], at[1] + 1}}}}})
        .size();
  };

  EXPECT_EQ(decode({first, second}, at[0]), 2U);
  EXPECT_THROW(decode({second, first}, at[0]), RunError);
  EXPECT_THROW(decode({first}, at[0] + 1), RunError);
}

}  // namespace
}  // namespace barchan::test
