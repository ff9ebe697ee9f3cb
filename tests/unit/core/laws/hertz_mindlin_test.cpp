#include <barchan/core/kernels/contact_law.hpp>
#include <barchan/core/laws/hertz_mindlin.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <unit/core/kernel_sample.hpp>

namespace barchan::test {
namespace {

constexpr int kHertz = 1;  // place in the list of laws

ContactConstants solid(double young_modulus, double poisson_ratio) {
  ContactConstants m;
  m.young_modulus = young_modulus;
  m.poisson_ratio = poisson_ratio;
  return m;
}

LawTable hertz_laws(int num_materials, const ContactRules& rules) {
  ContactTable table{num_materials, {}, rules.no_tension, kHertz, rules.tangential};
  for (int a = 0; a < num_materials; ++a) {
    for (int b = 0; b < num_materials; ++b) {
      ContactConstants p =
          HertzMindlin::mix(solid(1e4 + 3e3 * a, 0.1 * a), solid(1e4 + 3e3 * b, 0.1 * b)).value();
      p.mu = 0.15 * (a + b + 1);
      p.restitution = 0.9 - 0.05 * (a + b);
      HertzMindlin::solve(p, rules);
      table.constants.push_back(p);
    }
  }
  return LawTable(table);
}

std::vector<ContactRules> all_rules() {
  return {{true, Tangential::Mindlin},
          {false, Tangential::Mindlin},
          {true, Tangential::MindlinDisplacement},
          {false, Tangential::MindlinDisplacement}};
}

constexpr int kLength = HertzMindlin::kHistory<3>.length;

TEST(HertzMindlin, GivesTheSameBitsAtAnyWidth) {
  for (const ContactRules& rules : all_rules()) {
    for (const int num_materials : {1, 2, 5}) {
      for (int bits = 0; bits < 4; ++bits) {
        const LawTable laws = hertz_laws(num_materials, rules);
        const bool has_bonds = (bits & 1) != 0;
        const PeriodicBox box = box_of<3>((bits & 2) != 0);
        Sample<3> sample(40, 199, laws.size(), 11, kLength);
        for (auto& code : sample.list.code) code = std::max<std::uint8_t>(code, has_bonds ? 0 : 1);
        sample.barely(1, true);
        sample.barely(3, false);
        std::vector<Sample<3>> after;
        for (const VectorWidth width : vector_widths()) {
          after.push_back(sample);
          const KernelSet kernels = make_kernels(3, width, laws, has_bonds, box);
          for (int n = 0; n < 4; ++n) kernels.pairs(after.back().job(laws, box));
        }
        for (std::size_t w = 1; w < after.size(); ++w) {
          const auto what = fmt::format("{}, {} materials, bits {}", name_of(vector_widths()[w]),
                                        num_materials, bits);
          ASSERT_TRUE(same_bits(after[w].force, after[0].force)) << what;
          ASSERT_TRUE(same_values(after[w].list.history, after[0].list.history)) << what;
        }
      }
    }
  }
}

TEST(HertzMindlin, GivesEachEndWhatItGetsWhenTheEndsSwap) {
  using L = Layout<3>;
  for (const ContactRules& rules : all_rules()) {
    const LawTable laws = hertz_laws(2, rules);
    Sample<3> there(40, 300, laws.size(), 29, kLength), back = there;
    for (std::size_t k = 0; k < 300; ++k) std::swap(back.list.i[k], back.list.j[k]);

    const auto one_way = forces_of_pairs(there, laws, {}, 3);
    const auto other_way = forces_of_pairs(back, laws, {}, 3);

    int num_touching = 0;
    for (std::size_t k = 0; k < 300; ++k) {
      for (std::size_t q = 0; q < 3; ++q) {
        ASSERT_EQ(one_way[k][q], -other_way[k][q]);
        ASSERT_EQ(one_way[k][L::kTorque + q], other_way[k][L::kTorque + q]);
      }
      for (int c = 0; c < kLength; ++c) {
        const auto at = static_cast<std::int64_t>(k);
        ASSERT_EQ(there.list.history_of(at)[c * kBatch],
                  HertzMindlin::kHistory<3>.sign(c, true) * back.list.history_of(at)[c * kBatch]);
      }
      num_touching += one_way[k][0] != 0.0 ? 1 : 0;
    }
    EXPECT_GT(num_touching, 20);
  }
}

using State = TurningPair<simd::Scalar, 3>;

/// Two spheres of radius 1 and 3 along x, which are pressed by `overlap` and slide along y.
State pressed(double overlap, double slide) {
  State s{};
  s.dx = 4.0 - overlap;
  s.reach = 4.0;
  s.vy = slide;
  s.inverse_mass = 0.25;
  s.inverse_radius = 1.0 + 1.0 / 3.0;
  return s;
}

struct Contact {
  double row[LawView::kRow] = {};
  double history[kLength] = {};
  PairForce<simd::Scalar, 3> respond(const State& s, double dt) {
    return detail::respond_at<HertzMindlin, 3>(0, row, s, dt, history);
  }
};

Contact contact_of(Tangential tangential, double mu) {
  Contact c;
  ContactConstants p = HertzMindlin::mix(solid(1e6, 0.3), solid(2e6, 0.2)).value();
  p.mu = mu;
  HertzMindlin::write(p, {false, tangential}, c.row);
  return c;
}

TEST(HertzMindlin, PressesByTheThreeHalvesPowerOfTheOverlap) {
  Contact c = contact_of(Tangential::Mindlin, 0.0);
  const double e_star = 1.0 / (0.91 / 1e6 + 0.96 / 2e6);
  for (const double overlap : {1e-6, 1e-3, 0.1}) {
    const double wanted = 4.0 / 3.0 * e_star * std::sqrt(0.75 * overlap) * overlap;

    EXPECT_NEAR(c.respond(pressed(overlap, 0.0), 1e-6).fx, -wanted, 1e-9 * wanted) << overlap;
  }
}

TEST(HertzMindlin, StoresTheWorkThatPressedIt) {
  Contact c = contact_of(Tangential::Mindlin, 0.0);
  const int steps = 20000;
  const double deepest = 0.05;
  double work = 0.0;
  for (int n = 0; n < steps; ++n)
    work -= c.respond(pressed(deepest * (n + 0.5) / steps, 0.0), 1e-6).fx * deepest / steps;

  EXPECT_NEAR(
      HertzMindlin::energy(c.row, HertzMindlin::kHistory<3>, {deepest, 4.0 / 3.0}, c.history), work,
      1e-6 * work);
}

/// Slides at a deep overlap, goes to a shallow one, and comes back. @return tangential forces
std::vector<double> unload_and_load(Tangential tangential) {
  Contact c = contact_of(tangential, 10.0);
  std::vector<double> forces;
  (void)c.respond(pressed(0.04, 1e-3), 1e-3);
  for (const double overlap : {0.04, 0.01, 0.04})
    forces.push_back(c.respond(pressed(overlap, 0.0), 1e-3).fy);
  return forces;
}

TEST(HertzMindlin, ByIncrementsLosesOnUnloadingWhatTheSmallerAreaCannotBear) {
  const auto f = unload_and_load(Tangential::Mindlin);

  EXPECT_GT(f[0], 0.0);
  EXPECT_NEAR(f[1], 0.5 * f[0], 1e-12 * f[0]);
  EXPECT_NEAR(f[2], 0.5 * f[0], 1e-12 * f[0]);
}

TEST(HertzMindlin, ByDisplacementGoesWithTheArea) {
  const auto f = unload_and_load(Tangential::MindlinDisplacement);

  const double g_star = 1.0 / (1.7 * 2.6 / 1e6 + 1.8 * 2.4 / 2e6);
  const double a = std::sqrt(0.75 * 0.04);
  EXPECT_NEAR(f[0], 8.0 * g_star * a * 1e-6, 1e-9 * f[0]);
  EXPECT_NEAR(f[1], 0.5 * f[0], 1e-12 * f[0]);
  EXPECT_NEAR(f[2], f[0], 1e-12 * f[0]);
}

TEST(HertzMindlin, KeepsNothingWithoutFrictionOrOfABondedPair) {
  Contact free = contact_of(Tangential::Mindlin, 0.0), null;
  HertzMindlin::write({}, {true, Tangential::MindlinDisplacement}, null.row);
  for (Contact* c : {&free, &null}) {
    const auto force = c->respond(pressed(0.01, 0.5), 1e-3);

    EXPECT_EQ(force.fy, 0.0);
    for (const double number : c->history) EXPECT_EQ(number, 0.0);
  }
  EXPECT_EQ(null.respond(pressed(0.01, 0.5), 1e-3).fx, 0.0);
}

TEST(HertzMindlin, SolvesItsDashpotForTheClampOfTheRun) {
  const auto alpha = [](double e, bool no_tension) {
    ContactConstants p;
    p.restitution = e;
    HertzMindlin::solve(p, {no_tension, Tangential::Mindlin});
    return p.alpha;
  };

  EXPECT_NEAR(alpha(0.2, true), 1.6351, 1e-4);
  EXPECT_NEAR(alpha(0.5, true), 0.5708, 1e-4);
  EXPECT_NEAR(alpha(0.8, true), 0.1663, 1e-4);
  const double log = std::log(0.6);
  EXPECT_NEAR(alpha(0.6, false), -std::sqrt(5.0) * log / std::sqrt(log * log + M_PI * M_PI), 1e-12);
  EXPECT_EQ(alpha(1.0, true), 0.0);
}

TEST(HertzMindlin, TakesARigidBodyForInfinitelyStiff) {
  ContactConstants wall;
  wall.is_rigid = true;

  const ContactConstants p = HertzMindlin::mix(solid(1e7, 0.25), wall).value();

  EXPECT_NEAR(p.young_star, 1e7 / (1.0 - 0.0625), 1e-6);
  EXPECT_NEAR(p.shear_star, 4e6 / 1.75, 1e-6);
}

TEST(HertzMindlin, KnowsHowDeepAnImpactGoes) {
  const ContactConstants p = HertzMindlin::mix(solid(48e9, 0.2), solid(48e9, 0.2)).value();
  const Impact impact{0.5 * 2800.0 * 4.0 / 3.0 * M_PI * 1e-6, 0.005, 20.0};

  // Chung & Ooi 2011, test 1
  EXPECT_NEAR(HertzMindlin::struck_overlap(p, impact), 274.1e-6, 0.1e-6);
  EXPECT_NEAR(HertzMindlin::duration(p, impact), 40.34e-6, 0.02e-6);
  EXPECT_NEAR(HertzMindlin::pressed_overlap(p, 0.005, 10.697e3), 274.1e-6, 0.1e-6);
}

}  // namespace
}  // namespace barchan::test
