#include <barchan/core/search/contact_search.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include <unit/core/lane_fixture.hpp>

namespace barchan::test {
namespace {

using IdPairs = std::set<std::pair<std::int64_t, std::int64_t>>;
using ListedPairs = std::vector<std::pair<std::int32_t, std::int32_t>>;

/// Every pair by its definition, from plain data.
IdPairs close_pairs(int dimension, const Domain& domain, const std::vector<ParticleData>& all,
                    double skin) {
  IdPairs pairs;
  for (std::size_t p = 0; p < all.size(); ++p) {
    for (std::size_t q = p + 1; q < all.size(); ++q) {
      if (all[p].fixed && all[q].fixed) continue;
      double d2 = 0.0;
      for (int a = 0; a < dimension; ++a) {
        double d = std::fabs(all[p].position[a] - all[q].position[a]);
        if (domain.periodic[static_cast<std::size_t>(a)])
          d = std::min(d, domain.hi[a] - domain.lo[a] - d);
        d2 += d * d;
      }
      if (std::sqrt(d2) < all[p].radius + all[q].radius + skin)
        pairs.insert(std::minmax(all[p].id, all[q].id));
    }
  }
  return pairs;
}

template <int Dim>
void append(const Lane<Dim>& lane, const PairList& list, IdPairs& ids, ListedPairs* rows) {
  for (std::size_t k = 0; k < list.i.size(); ++k) {
    if (list.i[k] == lane.brick.store.waste()) continue;  // padding
    const auto& id = lane.brick.store.id;
    const auto [it, is_new] = ids.insert(std::minmax(id[static_cast<std::size_t>(list.i[k])],
                                                     id[static_cast<std::size_t>(list.j[k])]));
    EXPECT_TRUE(is_new) << "pair " << it->first << ", " << it->second << " comes twice";
    EXPECT_LT(list.i[k], list.j[k]);
    EXPECT_TRUE(lane.brick.store.is_owned(list.i[k]));
    if (rows != nullptr) rows->emplace_back(list.i[k], list.j[k]);
  }
}

struct Case {
  Domain domain;
  int count;
};

/// 1, 2, 3 or more cells along every axis, in every periodicity that the grid takes.
template <int Dim>
std::vector<Case> cases(double cutoff) {
  std::vector<Case> all;
  const double lengths[] = {1.4, 2.2, 3.3, 7.7};
  for (int shape = 0; shape < (Dim == 2 ? 16 : 64); ++shape) {
    for (int periodicity = 0; periodicity < (1 << Dim); ++periodicity) {
      Case c;
      bool is_possible = true;
      double volume = 1.0;
      for (int a = 0; a < Dim; ++a) {
        const double length = lengths[(shape >> (2 * a)) & 3] * cutoff;
        c.domain.lo[a] = -0.3 * a;
        c.domain.hi[a] = c.domain.lo[a] + length;
        volume *= length / cutoff;
        c.domain.periodic[static_cast<std::size_t>(a)] = ((periodicity >> a) & 1) != 0;
        is_possible = is_possible &&
                      (!c.domain.periodic[static_cast<std::size_t>(a)] || length > 2.0 * cutoff);
      }
      c.domain.strip_axis = (shape + periodicity) % Dim;
      c.count = static_cast<int>(2.0 * volume) + 3;
      if (is_possible) all.push_back(c);
    }
  }
  return all;
}

template <int Dim>
void expect_all_found() {
  const double radius = 0.5, skin = 0.1, cutoff = 2.0 * radius + skin;
  unsigned seed = 1;
  for (const Case& c : cases<Dim>(cutoff)) {
    const auto particles = random_particles(Dim, c.domain, c.count, radius, ++seed);
    const IdPairs expected = close_pairs(Dim, c.domain, particles, skin);
    ListedPairs in_order[2];
    for (const ContactSearchKind kind : {ContactSearchKind::Cells, ContactSearchKind::AllPairs}) {
      World<Dim> world = world_of<Dim>(c.domain, cutoff, skin, c.count);
      world.search = kind;
      Lanes<Dim> lanes(world, {0, world.grid.num_slabs()});
      lanes.seed(particles);

      IdPairs found;
      append(lanes[0], lanes[0].brick.pairs, found,
             &in_order[kind == ContactSearchKind::Cells ? 0 : 1]);

      ASSERT_EQ(found, expected) << "seed " << seed;
    }
    ASSERT_EQ(in_order[0], in_order[1]) << "seed " << seed;
    ASSERT_TRUE(std::ranges::is_sorted(in_order[0])) << "seed " << seed;
  }
}

TEST(ContactSearch, FindsEveryPairOnceAndInOrderInAnyDomainIn2D) {
  expect_all_found<2>();
}
TEST(ContactSearch, FindsEveryPairOnceAndInOrderInAnyDomainIn3D) {
  expect_all_found<3>();
}

template <int Dim>
void expect_found_across_cuts(bool is_periodic) {
  const double radius = 0.5, skin = 0.1, cutoff = 2.0 * radius + skin;
  Domain domain;
  domain.hi = Vec3(9.5 * cutoff, 3.2 * cutoff, Dim == 3 ? 2.5 * cutoff : 0.0);
  domain.periodic = {is_periodic, true, false};
  const auto particles = random_particles(Dim, domain, Dim == 2 ? 90 : 250, radius, 77);
  const IdPairs expected = close_pairs(Dim, domain, particles, skin);
  for (const auto& cuts : {std::vector<int>{0, 2, 9}, {0, 4, 6, 9}, {0, 2, 4, 6, 9}}) {
    World<Dim> world = world_of<Dim>(domain, cutoff, skin, 90);
    ASSERT_EQ(world.grid.num_slabs(), 9);
    Lanes<Dim> lanes(world, cuts);
    lanes.seed(particles);

    IdPairs found;
    for (std::size_t l = 0; l < lanes.size(); ++l) {
      append(lanes[l], lanes[l].brick.pairs, found, nullptr);
      IdPairs once_more;  // the other side of a cut finds the same pairs again
      append(lanes[l], lanes[l].brick.band(Side::Left).across, once_more, nullptr);
      append(lanes[l], lanes[l].brick.band(Side::Right).across, once_more, nullptr);
      found.insert(once_more.begin(), once_more.end());
    }

    EXPECT_EQ(found, expected) << cuts.size() - 1 << " lanes";
  }
}

TEST(ContactSearch, FindsEveryPairAcrossCuts) {
  for (const bool is_periodic : {false, true}) {
    expect_found_across_cuts<2>(is_periodic);
    expect_found_across_cuts<3>(is_periodic);
  }
}

TEST(ContactSearch, GivesBondedPairsTheNullLaw) {
  Domain domain;
  domain.hi = Vec3(5.0, 5.0, 0.0);
  std::vector<ParticleData> particles(3);
  for (int p = 0; p < 3; ++p) {
    auto& q = particles[static_cast<std::size_t>(p)];
    q = {p + 1, p % 2, 0.5, 1000.0, Vec3(1.0 + p, 1.0, 0.0), Vec3::Zero(), Vec3::Zero(), false};
  }
  World<2> world = world_of<2>(domain, 1.2, 0.1, 3, true);
  world.bond_laws = {BondLaw{"b", 1e5}};
  Lanes<2> lanes(world, {0, world.grid.num_slabs()});
  lanes.seed(particles, std::vector<BondData>{{1, 2, 0}});

  const PairList& list = lanes[0].brick.pairs;

  ASSERT_EQ(list.size(), kBatch);
  EXPECT_EQ(list.code[0], LawTable::kBonded);
  EXPECT_EQ(list.code[1], world.laws.code(1, 0));
}

}  // namespace
}  // namespace barchan::test
