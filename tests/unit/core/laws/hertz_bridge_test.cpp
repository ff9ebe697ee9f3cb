#include <barchan/core/laws/hertz_bridge.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <barchan/core/kernels/contact_law.hpp>
#include <barchan/core/model/contact_range.hpp>

#include <unit/core/kernel_sample.hpp>

namespace barchan::test {
namespace {

using std::numbers::pi;

constexpr int kBridge = 8, kRollingBridge = 9;  // places in the list of laws
constexpr int kLength = HertzBridge::kHistory<3>.length;

ContactConstants wet(double young_modulus, const Bridge& bridge, const ContactRules& rules) {
  ContactConstants m;
  m.young_modulus = young_modulus;
  m.poisson_ratio = 0.25;
  ContactConstants p = HertzBridge::mix(m, m).value();
  p.restitution = 0.8;
  p.mu = 0.3;
  p.mu_rolling = 0.1;
  p.cr = 0.2;
  p.bridge = bridge;
  HertzBridge::solve(p, rules);
  return p;
}

ContactTable wet_contacts(int law, int num_materials) {
  ContactTable table;
  table.num_materials = num_materials;
  table.law = law;
  table.adhesion = Adhesion::Bridge;
  table.twisting = law == kRollingBridge;
  for (int a = 0; a < num_materials; ++a) {
    for (int b = 0; b < num_materials; ++b) {
      const Bridge bridge{0.4 * (a + b), 0.1 * (a + b), 1e-3 * (a + b)};  // 0 and 0 stay dry
      table.constants.push_back(wet(1e4 + 3e3 * (a + b), bridge, table.rules()));
    }
  }
  return table;
}

TEST(Bridge, GivesTheSameBitsAtAnyWidth) {
  constexpr std::array kLaws{kBridge, kRollingBridge};
  for (const int law : kLaws) {
    const LawTable laws(wet_contacts(law, 3));
    Sample<3> sample(40, 199, laws.size(), 11, law == kBridge ? kLength : kLength + 4);
    std::vector<Sample<3>> after;
    for (const VectorWidth width : vector_widths()) {
      after.push_back(sample);
      const KernelSet kernels = make_kernels(3, width, laws, true, {});
      for (int n = 0; n < 4; ++n) {
        kernels.pairs(after.back().job(laws, {}));
        for (std::size_t i = 0; i < after.back().motion.size(); i += Layout<3>::kMotion)
          after.back().motion[i] *= 1.02;  // some part, and some of them hold
      }
    }
    for (std::size_t w = 1; w < after.size(); ++w) {
      ASSERT_TRUE(same_bits(after[w].force, after[0].force)) << name_of(vector_widths()[w]);
      ASSERT_TRUE(same_values(after[w].list.history, after[0].list.history));
    }
  }
}

/// Two spheres along x, or one at a wall.
struct Pulled {
  static constexpr double kRadius = 1e-3, kTension = 0.072, kAngle = 0.5, kVolume = 2e-11;
  static constexpr Bridge kBridgeOfWater{kTension, kAngle, kVolume};
  bool is_on_wall;
  ContactConstants constants;
  double row[LawView::kRow] = {};
  double history[kLength] = {};

  explicit Pulled(bool on_wall = false) : is_on_wall(on_wall) {
    const ContactRules rules;
    constants = wet(1e7, kBridgeOfWater, rules);
    HertzBridge::write(constants, rules, row);
  }
  [[nodiscard]] double reach() const { return is_on_wall ? kRadius : 2.0 * kRadius; }
  [[nodiscard]] double inverse_radius() const { return (is_on_wall ? 1.0 : 2.0) / kRadius; }
  /// Along the normal; positive: it pulls [N].
  double force(double overlap) {
    ContactLawIn<3>::State s{};
    s.dx = reach() - overlap;
    s.reach = reach();
    s.inverse_mass = 1e4;
    s.inverse_radius = inverse_radius();
    return listed_law(kBridge).spheres.respond(0, row, s, 1e-6, history).fx;
  }
  [[nodiscard]] double energy(double overlap) const {
    return HertzBridge::energy(row, HertzBridge::kHistory<3>, {overlap, inverse_radius(), reach()},
                               history);
  }
};

TEST(Bridge, PullsByWillettsFitUntilItRuptures) {
  Pulled c;
  const double rupture = (1.0 + 0.5 * Pulled::kAngle) * std::cbrt(Pulled::kVolume);
  const double most = 2.0 * pi * Pulled::kRadius * Pulled::kTension * std::cos(Pulled::kAngle);
  EXPECT_EQ(c.force(-1e-3 * rupture), 0.0) << "before touch nothing pulls";
  EXPECT_NEAR(c.force(1e-14), most, 1e-6 * most);
  for (const double share : {0.01, 0.2, 0.5, 0.9, 0.999}) {
    const double gap = share * rupture, x = gap * std::sqrt(Pulled::kRadius / Pulled::kVolume);
    EXPECT_NEAR(c.force(-gap), most / (1.0 + 1.05 * x + 2.5 * x * x), 1e-10 * most) << share;
    EXPECT_EQ(c.history[3], -1.0) << "the bridge alone holds";
  }
  EXPECT_EQ(c.force(-1.001 * rupture), 0.0);
  EXPECT_EQ(c.history[3], 0.0);
  EXPECT_EQ(c.force(-0.5 * rupture), 0.0) << "what has ruptured does not pull again";
}

TEST(Bridge, AtAWallIsThatOfSpheresOfTwiceTheSize) {
  Pulled spheres, wall(true);
  EXPECT_NEAR(wall.force(1e-14) / spheres.force(1e-14), 2.0, 1e-5);
  const double gap = 1e-4, x2 = gap * gap * 2.0 * Pulled::kRadius / Pulled::kVolume;
  const double most = 4.0 * pi * Pulled::kRadius * Pulled::kTension * std::cos(Pulled::kAngle);
  EXPECT_NEAR(wall.force(-gap), most / (1.0 + 1.05 * std::sqrt(x2) + 2.5 * x2), 1e-10 * most);
}

TEST(Bridge, ItsEnergyIsTheWorkOfPullingItApart) {
  Pulled c;
  (void)c.force(1e-9);
  const double rupture = HertzBridge::rupture(c.constants);
  constexpr int kIntervals = 2000;  // Simpson
  double work = 0.0;
  for (int n = 0; n <= kIntervals; ++n) {
    const double at = (1.0 - 1e-9) * rupture * n / kIntervals;
    const double weight = n == 0 || n == kIntervals ? 1.0 : n % 2 == 1 ? 4.0 : 2.0;
    work += weight * c.force(-at) * rupture / (3.0 * kIntervals);
  }
  EXPECT_NEAR(-c.energy(0.0) / work, 1.0, 1e-6);
  EXPECT_NEAR(c.energy(-rupture), 0.0, 1e-12 * work);
}

TEST(Bridge, ForceIsTheSlopeOfItsEnergy) {
  Pulled c;
  (void)c.force(1e-9);
  for (const double overlap : {-2e-4, -5e-5, -1e-6, 1e-6, 2e-5, 1e-4}) {
    const double h = 1e-5 * std::fabs(overlap);
    const double slope = (c.energy(overlap + h) - c.energy(overlap - h)) / (2.0 * h);
    EXPECT_NEAR(slope, -c.force(overlap), 1e-5 * std::fabs(slope)) << overlap;
  }
}

// Measures come between steps: what has just gone too far is still in the history.
TEST(Bridge, HasAnEnergyWhereverItIsMeasured) {
  const ContactTable contacts = wet_contacts(kRollingBridge, 2);
  double row[LawView::kRow] = {};
  WithRolling<HertzBridge>::write(contacts.at(1, 1), contacts.rules(), row);
  const double history[kLength + 4] = {0, 0, 0, -1.0};
  for (const double overlap : {-0.5, -0.1, -1e-3, 0.0, 1e-3})
    EXPECT_TRUE(std::isfinite(
        listed_law(kRollingBridge).spheres.energy(row, {overlap, 2.0, 1.0}, history)));
}

TEST(Bridge, HoldsAsFarAsItsRangeSays) {
  const ContactTable contacts = wet_contacts(kBridge, 2);
  const double range = contact_range(contacts, 0.5);
  EXPECT_DOUBLE_EQ(range, HertzBridge::rupture(contacts.at(1, 1)));
  EXPECT_NEAR(contact_range_within(contacts, 1.0 + range), range, 1e-9 * range);
}

TEST(Bridge, ADryPairIsHertz) {
  Pulled c;
  c.constants.bridge = {};
  HertzBridge::write(c.constants, {}, c.row);
  double row[LawView::kRow] = {}, history[kLength] = {};
  HertzMindlin::write(c.constants, {}, row);
  ContactLawIn<3>::State s{};
  s.reach = 2e-3;
  s.inverse_mass = 1e4;
  s.inverse_radius = 2e3;
  for (const double overlap : {1e-7, 1e-5, -1e-7, 1e-6}) {
    s.dx = s.reach - overlap;
    EXPECT_EQ(c.force(overlap), listed_law(1).spheres.respond(0, row, s, 1e-6, history).fx);
    EXPECT_EQ(c.history[3], history[3]);
  }
}

// Nothing of rolling or twisting outlasts the touch, though the contact does.
TEST(Bridge, KeepsNoRollingSpringFromAfar) {
  const ContactTable contacts = wet_contacts(kRollingBridge, 2);
  double row[LawView::kRow] = {};
  WithRolling<HertzBridge>::write(contacts.at(1, 1), contacts.rules(), row);
  double history[kLength + 4] = {};
  ContactLawIn<3>::State s{};
  s.reach = 1.0;
  s.inverse_mass = 1.0;
  s.inverse_radius = s.inverse_first = s.inverse_second = 2.0;
  s.turn_x = 0.3, s.turn_y = 0.2, s.turn_z = 0.1;
  for (const double dx : {0.98, 1.01, 1.02}) {
    s.dx = dx;
    (void)listed_law(kRollingBridge).spheres.respond(0, row, s, 1e-2, history);
    EXPECT_EQ(history[3], dx < 1.0 ? history[3] : -1.0);
    for (int c = kLength; c < kLength + 4; ++c)
      EXPECT_EQ(history[c] != 0.0, dx < 1.0 && c != kLength) << c << " at " << dx;
  }
}

}  // namespace
}  // namespace barchan::test
