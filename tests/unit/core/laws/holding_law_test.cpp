#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include <barchan/core/kernels/batch_scalar.hpp>
#include <barchan/core/kernels/contact_law.hpp>
#include <barchan/core/kernels/pair_loop.hpp>
#include <barchan/core/laws/linear_spring.hpp>

#include <unit/core/lane_fixture.hpp>

// Contacts that hold beyond touch: lists, packing, rebuilds and checkpoints know how far.

namespace barchan::test {
namespace {

constexpr double kHold = 0.08;  ///< beyond touch [m]

/// A central spring that pulls, too: from touch on until the two are kHold apart. Nothing but a
/// flag says that a contact is held.
struct HoldingSpring {
  static constexpr const char* kName = "holding";
  static constexpr bool kIsForDisks = true;
  enum Field { Kn, kNumFields };
  enum Level { Only, kNumLevels };
  static constexpr int fields_read(int /*level*/) { return kNumFields; }
  static constexpr bool is_common(int /*field*/) { return false; }
  template <class S>
  struct Constants {
    typename S::Real kn;
  };
  template <int Dim>
  static constexpr History kHistory{1, 0};
  template <class S, int Dim>
  using Force = PairForce<S, Dim>;
  template <class S, int Dim>
  using State = PairState<S, Dim>;

  static double energy(const double* row, const History& /*history*/, const Overlap& overlap,
                       const double* /*numbers*/) {
    return 0.5 * row[Kn] * overlap.depth * overlap.depth;
  }

  template <class S, int Level, int Dim>
  static typename S::Mask respond(const Constants<S>& c, const PairState<S, Dim>& p,
                                  typename S::Real /*dt*/, typename S::Real (&flag)[1],
                                  PairForce<S, Dim>& out) {
    using Real = typename S::Real;
    Real d2 = p.dx * p.dx + p.dy * p.dy;
    if constexpr (Dim == 3) d2 = d2 + p.dz * p.dz;
    const Real far = p.reach + S::set(kHold), zero = S::set(0.0);
    const Real held = S::select(S::less(zero, flag[0]), far, p.reach);
    const auto holds = S::less(d2, held * held);
    flag[0] = S::where(holds, S::set(1.0));
    out = {};
    if (!S::any(holds)) return holds;
    const Real d = S::sqrt(d2), pull = c.kn * (d - p.reach) / d;
    out.fx = pull * p.dx;
    out.fy = pull * p.dy;
    if constexpr (Dim == 3) out.fz = pull * p.dz;
    out.size = S::abs(c.kn * (d - p.reach));
    return holds;
  }
};

LawTable holding_laws() {
  const auto kernel = [](VectorWidth /*width*/, int dim, int variant) {
    return kernels::pick_in<HoldingSpring, kernels::BatchScalar>(dim, variant);
  };
  return {contact_law<HoldingSpring>(kernel), 0, 2,
          [](int a, int /*b*/, double* row) { row[HoldingSpring::Kn] = a < 0 ? 0.0 : 2e4; }};
}

template <int Dim>
struct Box {
  Domain domain;
  World<Dim> world;
  std::vector<ParticleData> particles;

  Box() {
    domain.hi = Vec3(14.0, 3.4, Dim == 3 ? 2.3 : 0.0);
    domain.periodic = {true, false, Dim == 3};
    world = world_of<Dim>(domain, 1.1, 0.1 - kHold, 200);
    world.range = kHold;
    world.laws = holding_laws();
    world.kernels = make_kernels(Dim, VectorWidth::Scalar, world.laws, false, world.grid.box());
    particles = random_particles(Dim, domain, Dim == 2 ? 120 : 220, 0.45, 5);
    for (ParticleData& p : particles) p.velocity *= 12.0;
  }
};

/// Held contacts of two that do not touch, of those that count here.
template <int Dim>
int count_apart(const Brick<Dim>& brick) {
  const ParticleStore<Dim>& store = brick.store;
  int apart = 0;
  brick.for_each_counted([&](const PairList& list, const PairBlock& block) {
    block.for_each_candidate(list, [&](std::size_t k, const double* flag) {
      const std::int32_t i = list.i[k], j = list.j[k];
      const double reach = store.radius(i) + store.radius(j);
      const double d2 = distance2<Dim>(brick.world->grid.box(), store.x(i), store.x(j));
      apart += *flag != 0.0 && d2 > reach * reach ? 1 : 0;
    });
  });
  return apart;
}

template <int Dim>
void expect_held_on_any_cuts() {
  Box<Dim> box;
  const std::vector<std::vector<int>> layouts{{0, 3, 6, 12}, {0, 4, 8, 12}, {0, 3, 7, 12}};
  Lanes<Dim> many(box.world, layouts[0]), one(box.world, {0, 12});
  many.seed(box.particles);
  one.seed(box.particles);
  for (int round = 0; round < 12; ++round) {
    for (int n = 0; n < 4; ++n) many.step(), one.step();
    bool before_agrees = false, after_agrees = false;
    const Springs before = many.springs(before_agrees);

    many.rebuild(layouts[static_cast<std::size_t>(round % 3)]);
    if (round % 3 == 0) one.rebuild({0, 12});

    EXPECT_TRUE(before_agrees);
    EXPECT_EQ(many.springs(after_agrees), before) << "round " << round;
    EXPECT_TRUE(after_agrees);
    EXPECT_EQ(many.digest(), one.digest()) << "round " << round;
  }
  EXPECT_GT(count_apart(one[0].brick), 3) << "contacts should be held beyond touch";
}

TEST(HoldingLaw, ContactsHoldBeyondTouchOnAnyCutsAndThroughRebuilds) {
  expect_held_on_any_cuts<2>();
  expect_held_on_any_cuts<3>();
}

TEST(HoldingLaw, ACheckpointKeepsContactsThatDoNotTouch) {
  Box<3> box;
  Lanes<3> one(box.world, {0, 12}), again(box.world, {0, 12});
  one.seed(box.particles);
  for (int n = 0; n < 40; ++n) {
    one.step();
    if (n % 4 == 3) one.rebuild({0, 12});
  }
  ASSERT_GT(count_apart(one[0].brick), 10);
  std::vector<CheckpointShare> shares(1);
  barchan::save(one[0].brick, shares[0]);

  again.restore(shares);

  EXPECT_EQ(count_apart(again[0].brick), count_apart(one[0].brick));
  for (int n = 0; n < 4; ++n) one.step(), again.step();
  EXPECT_EQ(again.digest(), one.digest());
}

}  // namespace
}  // namespace barchan::test
