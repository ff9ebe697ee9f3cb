#include <barchan/core/links/bonds.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

/// Unit spheres or disks of mass one in a row along x, ids from 1.
template <int Dim>
ParticleStore<Dim> row_of(int count, double spacing) {
  ParticleStore<Dim> s;
  s.num_owned = count;
  s.resize_for_ghosts();
  s.start_extra(0, s.num_owned);
  for (std::int32_t i = 0; i < count; ++i) {
    s.x(i)[0] = spacing * i;
    s.x(i)[Layout<Dim>::kRadius] = 1.0;
    s.x(i)[Layout<Dim>::kInverseMass] = 1.0;
    s.id[static_cast<std::size_t>(i)] = i + 1;
    s.key[static_cast<std::size_t>(i)] = i;
    s.flags[static_cast<std::size_t>(i)] = ParticleStore<Dim>::kBonded;
  }
  return s;
}

template <int Dim>
Bond<Dim> bond_of(std::int64_t a, std::int64_t b, double length) {
  Bond<Dim> bond;
  bond.id_a = a;
  bond.id_b = b;
  bond.length = length;
  return bond;
}

BondLaw elastic() {
  BondLaw law;
  law.young_modulus = 600.0;
  law.stiffness_ratio = 3.0;
  return law;
}

TEST(Bonds, SectionIsThatOfABeam) {
  const BondSection flat = bond_section<2>(elastic(), 2.0, 1.0, 1.5),
                    round = bond_section<3>(elastic(), 2.0, 1.5, 1.0);

  EXPECT_DOUBLE_EQ(flat.kn, 600.0 * 2.0 / 2.0);
  EXPECT_DOUBLE_EQ(flat.ks, flat.kn / 3.0);
  EXPECT_DOUBLE_EQ(flat.bending, 600.0 * (2.0 / 3.0) / 2.0);
  EXPECT_DOUBLE_EQ(round.kn, 600.0 * std::numbers::pi / 2.0);
  EXPECT_DOUBLE_EQ(round.bending, 600.0 * (std::numbers::pi / 4.0) / 2.0);
  EXPECT_DOUBLE_EQ(round.twisting, 600.0 / 3.0 * (std::numbers::pi / 2.0) / 2.0);
}

template <int Dim>
void expect_pulls_together() {
  ParticleStore<Dim> store = row_of<Dim>(2, 2.1);
  BondSet<Dim> bonds;
  bonds.add(bond_of<Dim>(1, 2, 2.0));
  bonds.resolve(store);
  const std::vector<BondLaw> laws{elastic()};

  EXPECT_TRUE(bonds.compute(BondSet<Dim>::Owned, store, laws, {}, 1e-3).empty());
  bonds.add_to_rows(store, 0, 2);

  const double expected = bond_section<Dim>(laws[0], 2.0, 1.0, 1.0).kn * 0.1;
  EXPECT_NEAR(store.e(0)[0], expected, 1e-9 * expected);
  EXPECT_EQ(store.e(1)[0], -store.e(0)[0]);
  EXPECT_NEAR(bonds.energy(0, store, laws, {}), 0.5 * expected * 0.1, 1e-9);
}

TEST(Bonds, PullTogetherWhatIsTooFarApart) {
  expect_pulls_together<2>();
  expect_pulls_together<3>();
}

template <int Dim>
void expect_the_short_way() {
  ParticleStore<Dim> store = row_of<Dim>(2, 7.9);  // 2.1 the other way around
  PeriodicBox box;
  box.length[0] = 10.0;
  box.inverse[0] = 0.1;
  BondSet<Dim> bonds;
  bonds.add(bond_of<Dim>(1, 2, 2.0));
  bonds.resolve(store);
  const std::vector<BondLaw> laws{elastic()};

  EXPECT_TRUE(bonds.compute(BondSet<Dim>::Owned, store, laws, box, 1e-3).empty());
  bonds.add_to_rows(store, 0, 2);

  const double expected = bond_section<Dim>(laws[0], 2.0, 1.0, 1.0).kn * 0.1;
  EXPECT_NEAR(store.e(0)[0], -expected, 1e-9 * expected);
  EXPECT_EQ(store.e(1)[0], -store.e(0)[0]);
  EXPECT_NEAR(bonds.energy(0, store, laws, box), 0.5 * expected * 0.1, 1e-9);
}

TEST(Bonds, GoTheShortWayAroundAPeriodicBox) {
  expect_the_short_way<2>();
  expect_the_short_way<3>();
}

TEST(Bonds, HaveTheLengthOfTheirFileAndElseThatOfTheStart) {
  BondData data{1, 2, 0};
  EXPECT_EQ(barchan::bond_of<2>(data, 0.2).length, 0.2);
  data.length = 0.3;
  EXPECT_EQ(barchan::bond_of<2>(data, 0.2).length, 0.3);
  EXPECT_EQ(barchan::bond_of<3>(data, 0.2).length, 0.3);
}

TEST(Bonds, BreakAtTheirTensileStrengthAndStayBroken) {
  ParticleStore<2> store = row_of<2>(2, 2.1);
  BondSet<2> bonds;
  bonds.add(bond_of<2>(1, 2, 2.0));
  bonds.resolve(store);
  BondLaw law = elastic();  // tension: 600·0.1/2 = 30 Pa
  law.tensile_strength = 30.1;
  EXPECT_TRUE(bonds.compute(BondSet<2>::Owned, store, std::vector{law}, {}, 1e-3).empty());
  law.tensile_strength = 29.9;

  EXPECT_EQ(bonds.compute(BondSet<2>::Owned, store, std::vector{law}, {}, 1e-3).size(), 1U);
  bonds.add_to_rows(store, 0, 2);

  EXPECT_TRUE(bonds.is_broken(0));
  EXPECT_EQ(bonds.num_broken(), 1);
  EXPECT_EQ(store.e(0)[0], 0.0);
  bonds.drop_broken();
  EXPECT_TRUE(bonds.empty());
}

TEST(Bonds, BendingMomentActsAgainstRelativeRotation) {
  ParticleStore<2> store = row_of<2>(2, 2.0);
  store.u(1)[0] = 1.0;
  store.u(0)[0] = -1.0;  // arms cancel: pure bending
  BondSet<2> bonds;
  bonds.add(bond_of<2>(1, 2, 2.0));
  bonds.resolve(store);

  (void)bonds.compute(BondSet<2>::Owned, store, std::vector{elastic()}, {}, 1e-3);
  bonds.add_to_rows(store, 0, 2);

  const double moment = bond_section<2>(elastic(), 2.0, 1.0, 1.0).bending * 2.0 * 1e-3;
  EXPECT_NEAR(store.e(0)[2], moment, 1e-12);
  EXPECT_NEAR(store.e(1)[2], -moment, 1e-12);
  EXPECT_NEAR(store.e(0)[1], 0.0, 1e-12);
}

TEST(Bonds, ConserveMomentumAndAngularMomentumIn3D) {
  ParticleStore<3> store = row_of<3>(2, 2.05);
  for (int c = 0; c < 3; ++c) {
    store.v(0)[c] = 0.3 * c - 0.2;
    store.v(1)[c] = 0.5 - 0.4 * c;
    store.u(0)[c] = 0.2 * c + 0.1;
    store.u(1)[c] = 0.7 - 0.1 * c;
  }
  BondLaw law = elastic();
  law.damping_ratio = 0.2;
  BondSet<3> bonds;
  bonds.add(bond_of<3>(1, 2, 2.0));
  bonds.resolve(store);

  (void)bonds.compute(BondSet<3>::Owned, store, std::vector{law}, {}, 1e-3);
  bonds.add_to_rows(store, 0, 2);

  // Torque about particle 1: T1 + T2 + d × F2 = 0; records hold torque over radius, and radii
  // are 1.
  const double *f = store.e(0), *g = store.e(1), d = 2.05;
  const double lever[3] = {0.0, -d * g[2], d * g[1]};
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(f[c], -g[c]);
    EXPECT_NEAR(f[4 + c] + g[4 + c] + lever[c], 0.0, 1e-9);
  }
  EXPECT_GT(std::fabs(f[1]), 1e-3);
}

TEST(Bonds, KnownBondsTakeTheCurrentStateOnly) {
  Bond<2> bond = bond_of<2>(1, 2, 2.0);
  BondSet<2> bonds;
  bonds.add(bond);
  bond.state = {3.0, 4.0};
  bonds.add(bond, false);
  EXPECT_EQ(bonds.bonds()[0].state[0], 0.0);

  bonds.add(bond, true);

  EXPECT_EQ(bonds.bonds().size(), 1U);
  EXPECT_EQ(bonds.bonds()[0].state[0], 3.0);
}

TEST(Bonds, WithoutAnOwnedEndAreForgottenAndWithALostOneRefused) {
  ParticleStore<2> store = row_of<2>(3, 2.0);
  BondSet<2> bonds;
  bonds.add(bond_of<2>(1, 2, 2.0));
  bonds.add(bond_of<2>(8, 9, 2.0));
  bonds.resolve(store);
  EXPECT_EQ(bonds.bonds().size(), 1U);

  bonds.add(bond_of<2>(3, 9, 2.0));
  EXPECT_THROW(bonds.resolve(store), RunError);
}

}  // namespace
}  // namespace barchan
