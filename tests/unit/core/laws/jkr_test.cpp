#include <barchan/core/laws/jkr.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include <barchan/core/kernels/contact_law.hpp>
#include <barchan/core/model/contact_range.hpp>

#include <unit/core/kernel_sample.hpp>

namespace barchan::test {
namespace {

using simd::Scalar;
using std::numbers::pi;

constexpr int kJkr = 6;  // place in the list of laws
constexpr int kLength = Jkr::kHistory<3>.length;
constexpr double kPullLimit = -0.2751606040745522, kPullPeak = -0.1322834209973500;

TEST(Jkr, TakesCubeRootsAtAnyScale) {
  for (int e = -40; e <= 40; ++e) {
    for (const double x : {1.0, 1.3, 1.9, 2.7, 3.999, 5.0, 7.3}) {
      const double a = x * std::pow(10.0, 0.5 * e);
      EXPECT_NEAR(Jkr::cube_root<Scalar>(a) / std::cbrt(a), 1.0, 1e-14) << a;
    }
  }
}

TEST(Jkr, FindsTheRootOfItsEquation) {
  for (const double above : {1e-4, 1e-3, 0.01, 0.1, 0.2751606040745522, 0.5, 1.0, 10.0, 1e3, 1e6}) {
    const double d = kPullLimit + above, s = Jkr::root<Scalar>(d);
    const long double exact = s, slope = 4 * exact * exact * exact - 2.0L / 3.0L;
    const long double rest = exact * exact * exact * exact - 2.0L / 3.0L * exact - d;
    EXPECT_LT(std::fabs(static_cast<double>(rest / slope)) / s, 1e-14) << above;
    EXPECT_GT(s, 0.5503) << "the larger root";
  }
}

ContactConstants solid(double young_modulus, double poisson_ratio, double surface_energy) {
  ContactConstants m;
  m.young_modulus = young_modulus;
  m.poisson_ratio = poisson_ratio;
  m.surface_energy = surface_energy;
  return m;
}

ContactTable jkr_contacts(int num_materials, const ContactRules& rules) {
  ContactTable table;
  table.num_materials = num_materials;
  table.no_tension = rules.no_tension;
  table.law = kJkr;
  table.tangential = rules.tangential;
  table.pull_off = rules.pull_off;
  for (int a = 0; a < num_materials; ++a) {
    for (int b = 0; b < num_materials; ++b) {
      ContactConstants p =
          Jkr::mix(solid(1e4 + 3e3 * a, 0.1 * a, 20.0 * a), solid(1e4 + 3e3 * b, 0.1 * b, 20.0 * b))
              .value();
      p.mu = 0.15 * (a + b);
      p.restitution = 0.9 - 0.05 * (a + b);
      Jkr::solve(p, rules);
      table.constants.push_back(p);
    }
  }
  return table;
}

TEST(Jkr, GivesTheSameBitsAtAnyWidth) {
  for (const PullOff pull_off : {PullOff::Limit, PullOff::Peak}) {
    for (const bool no_tension : {false, true}) {
      const LawTable laws(
          jkr_contacts(3, {no_tension, Tangential::Mindlin, false, Adhesion::None, pull_off}));
      Sample<3> sample(40, 199, laws.size(), 11, kLength);
      std::vector<Sample<3>> after;
      for (const VectorWidth width : vector_widths()) {
        after.push_back(sample);
        const KernelSet kernels = make_kernels(3, width, laws, true, {});
        for (int n = 0; n < 4; ++n) kernels.pairs(after.back().job(laws, {}));
      }
      for (std::size_t w = 1; w < after.size(); ++w) {
        ASSERT_TRUE(same_bits(after[w].force, after[0].force)) << name_of(vector_widths()[w]);
        ASSERT_TRUE(same_values(after[w].list.history, after[0].list.history));
      }
    }
  }
}

/// Two spheres of radius 2 mm along x, glass with a surface energy of 0.05 J/m².
struct Pulled {
  static constexpr double kRadius = 1e-3, kEnergy = 0.05;  ///< reduced
  ContactConstants constants;
  ContactRules rules;
  double row[LawView::kRow] = {};
  double history[kLength] = {};

  explicit Pulled(const ContactRules& of, double surface_energy = kEnergy) : rules(of) {
    constants =
        Jkr::mix(solid(1e7, 0.25, surface_energy), solid(1e7, 0.25, surface_energy)).value();
    constants.restitution = 1.0;
    Jkr::solve(constants, rules);
    Jkr::write(constants, rules, row);
  }
  /// Along the normal; positive: it pulls [N].
  double force(double overlap, double vn = 0.0) {
    ContactLawIn<3>::State s{};
    s.dx = 4e-3 - overlap;
    s.reach = 4e-3;
    s.vx = vn;
    s.inverse_mass = 1e4;
    s.inverse_radius = 1.0 / kRadius;
    const ContactLaw law = listed_law(kJkr);
    return law.spheres.respond(0, row, s, 1e-6, history).fx;
  }
  [[nodiscard]] bool is_held() const { return history[3] > 0.0; }
  [[nodiscard]] double scale() const {  ///< overlap of D = 1 [m]
    const double a0 = std::cbrt(9.0 * pi * kEnergy * kRadius * kRadius / constants.young_star);
    return a0 * a0 / kRadius;
  }
};

TEST(Jkr, PullsApartAtThePublishedForces) {
  Pulled c({});
  const double most = 3.0 * pi * Pulled::kEnergy * Pulled::kRadius;
  EXPECT_EQ(c.force(-1e-3 * c.scale()), 0.0) << "before touch nothing pulls";
  EXPECT_NEAR(c.force(1e-12 * c.scale()), 8.0 / 9.0 * most, 1e-9 * most);
  EXPECT_NEAR(c.force(kPullPeak * c.scale()), most, 1e-12 * most);
  EXPECT_NEAR(c.force((kPullLimit + 1e-9) * c.scale()), 5.0 / 9.0 * most, 1e-3 * most);
  EXPECT_TRUE(c.is_held());
  EXPECT_EQ(c.force((kPullLimit - 1e-9) * c.scale()), 0.0);
  EXPECT_FALSE(c.is_held());
  EXPECT_EQ(c.force(-1e-3 * c.scale()), 0.0) << "what has parted does not pull again";
}

TEST(Jkr, EndsAtThePeakWhereAsked) {
  ContactRules rules;
  rules.pull_off = PullOff::Peak;
  Pulled c(rules);
  (void)c.force(0.1 * c.scale());
  EXPECT_GT(c.force((kPullPeak + 1e-9) * c.scale()), 0.0);
  EXPECT_EQ(c.force((kPullPeak - 1e-9) * c.scale()), 0.0);
}

TEST(Jkr, IsHertzWithoutSurfaceEnergy) {
  Pulled c({}, 0.0);
  double row[LawView::kRow] = {};
  HertzMindlin::write(c.constants, c.rules, row);
  const ContactLaw hertz = listed_law(1);
  for (const double overlap : {1e-7, 1e-6, 1e-5, 1e-4}) {
    ContactLawIn<3>::State s{};
    s.dx = 4e-3 - overlap;
    s.reach = 4e-3;
    s.inverse_mass = 1e4;
    s.inverse_radius = 1.0 / Pulled::kRadius;
    double history[kLength] = {};
    const double expected = hertz.spheres.respond(0, row, s, 1e-6, history).fx;
    EXPECT_NEAR(c.force(overlap) / expected, 1.0, 1e-9) << overlap;
  }
}

TEST(Jkr, ForceIsTheSlopeOfItsEnergy) {
  Pulled c({});
  (void)c.force(0.1 * c.scale());
  const auto energy = [&](double d) {
    return Jkr::energy(c.row, Jkr::kHistory<3>, {d * c.scale(), 1.0 / Pulled::kRadius}, c.history);
  };
  for (const double d : {-0.27, -0.2, -0.1, 0.0, 0.3, 2.0, 40.0}) {
    const double h = 1e-5;
    const double slope = (energy(d + h) - energy(d - h)) / (2.0 * h * c.scale());
    EXPECT_NEAR(slope, -c.force(d * c.scale()), 1e-5 * std::fabs(slope) + 1e-9) << d;
  }
}

// Measures come between steps: what has just gone too far is still in the history.
TEST(Jkr, HasAnEnergyWhereverItIsMeasured) {
  Pulled c({});
  (void)c.force(0.1 * c.scale());
  for (const double d : {-0.5, kPullLimit, -0.1, 0.0, 0.3})
    EXPECT_TRUE(std::isfinite(
        Jkr::energy(c.row, Jkr::kHistory<3>, {d * c.scale(), 1.0 / Pulled::kRadius}, c.history)));
}

TEST(Jkr, HoldsAsFarAsItsRangeSays) {
  for (const PullOff pull_off : {PullOff::Limit, PullOff::Peak}) {
    const ContactTable contacts =
        jkr_contacts(2, {true, Tangential::Mindlin, false, Adhesion::None, pull_off});
    const double range = contact_range(contacts, 0.5);
    EXPECT_GT(range, 0.0);
    EXPECT_NEAR(contact_range_within(contacts, 1.0 + range), range, 1e-9 * range);
    double row[LawView::kRow] = {};
    Jkr::write(contacts.at(1, 1), contacts.rules(), row);
    const ContactLaw law = listed_law(kJkr);
    for (const double share : {0.999, 1.001}) {
      ContactLawIn<3>::State s{};
      s.dx = 0.5 + share * range;
      s.reach = 0.5;
      s.inverse_mass = 1.0;
      s.inverse_radius = 2.0;  // against a wall
      double history[kLength] = {0.0, 0.0, 0.0, 0.1};
      const double fx = law.spheres.respond(0, row, s, 1e-6, history).fx;
      EXPECT_EQ(fx > 0.0, share < 1.0);
      EXPECT_EQ(history[3] > 0.0, share < 1.0);
    }
  }
}

}  // namespace
}  // namespace barchan::test
