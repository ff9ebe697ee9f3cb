#include <barchan/core/laws/hertz_adhesive.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <barchan/core/kernels/contact_law.hpp>
#include <unit/core/kernel_sample.hpp>

namespace barchan::test {
namespace {

constexpr int kAdhesive = 4, kAdhesiveRolling = 5;  // places in the list of laws
constexpr double kPi = std::numbers::pi;

LawTable adhesive_laws(int law, int num_materials, Adhesion adhesion) {
  ContactTable table{num_materials, {}, true, law, Tangential::Mindlin};
  table.adhesion = adhesion;
  for (int a = 0; a < num_materials; ++a) {
    for (int b = 0; b < num_materials; ++b) {
      ContactConstants p;
      p.young_star = 1e4 + 1e3 * (a + b);
      p.shear_star = 3e3;
      p.alpha = 0.3;
      p.mu = 0.2 + 0.1 * (a + b);
      p.mu_rolling = 0.1;
      p.surface_energy = 3.0 * (a + b);  // one pair without
      p.cohesion_density = 200.0 * (a + b + 1);
      table.constants.push_back(p);
    }
  }
  return LawTable(table);
}

TEST(HertzAdhesive, GivesTheSameBitsAtAnyWidth) {
  for (const Adhesion adhesion : {Adhesion::Dmt, Adhesion::Sjkr, Adhesion::Sjkr2}) {
    for (const int law : {kAdhesive, kAdhesiveRolling}) {
      for (const int num_materials : {1, 2, 5}) {
        const LawTable laws = adhesive_laws(law, num_materials, adhesion);
        Sample<3> sample(40, 199, laws.size(), 11, history_in<3>(law).length);
        for (auto& code : sample.list.code) code = std::max<std::uint8_t>(code, 1);
        sample.barely(1, true);
        std::vector<Sample<3>> after;
        for (const VectorWidth width : vector_widths()) {
          after.push_back(sample);
          const KernelSet kernels = make_kernels(3, width, laws, false, {});
          for (int n = 0; n < 4; ++n) kernels.pairs(after.back().job(laws, {}));
        }
        for (std::size_t w = 1; w < after.size(); ++w) {
          const auto what =
              fmt::format("{}, law {}, {} materials, adhesion {}", name_of(vector_widths()[w]), law,
                          num_materials, static_cast<int>(adhesion));
          ASSERT_TRUE(same_bits(after[w].force, after[0].force)) << what;
          ASSERT_TRUE(same_values(after[w].list.history, after[0].list.history)) << what;
        }
      }
    }
  }
}

using State = TurningPair<simd::Scalar, 3>;

/// Of a sphere of radius r with another one, or with a plane.
struct Contact {
  double row[LawView::kRow] = {};
  double history[4] = {};
  double reach, inverse_radius;

  Contact(const ContactConstants& p, Adhesion adhesion, double r, double other)
      : reach(r + other), inverse_radius(1.0 / r + (other > 0.0 ? 1.0 / other : 0.0)) {
    HertzAdhesive::write(p, {true, Tangential::Mindlin, false, adhesion}, row);
  }
  /// Along the normal; above zero it pulls.
  double force(double overlap) {
    State s{};
    s.dx = reach - overlap;
    s.reach = reach;
    s.inverse_mass = 1.0;
    s.inverse_radius = inverse_radius;
    return detail::respond_at<HertzAdhesive, 3>(0, row, s, 1e-6, history).fx;
  }
  [[nodiscard]] double energy(double overlap) const {
    return HertzAdhesive::energy(row, HertzAdhesive::kHistory<3>, {overlap, inverse_radius, reach},
                                 history);
  }
};

ContactConstants powder() {
  ContactConstants p;
  p.young_star = 1e7 / (2.0 * 0.91);
  p.shear_star = 1e6;
  p.surface_energy = 0.05;
  p.cohesion_density = 3e4;
  return p;
}

TEST(HertzAdhesive, PullsByDmtFromTouchToTouch) {
  Contact c(powder(), Adhesion::Dmt, 1e-3, 1e-3);  // R = 0.5 mm

  EXPECT_NEAR(-c.force(2e-6), 1.49178121e-4, 1e-8 * 1.5e-4);
  EXPECT_NEAR(c.force(1e-15), 3.14159265e-4, 1e-8 * 3.2e-4);
  EXPECT_EQ(c.force(-1e-9), 0.0);
}

TEST(HertzAdhesive, PullsByTheAreaOfTheLens) {
  const double r = 1e-3, q = 2.5e-3, overlap = 1e-5, d = r + q - overlap;
  const double cap = (d * d + r * r - q * q) / (2.0 * d);
  const double area = kPi * (r * r - cap * cap);
  ContactConstants p = powder();
  p.young_star = 1e-9;

  Contact spheres(p, Adhesion::Sjkr, r, q), plane(p, Adhesion::Sjkr, r, 0.0);

  EXPECT_NEAR(spheres.force(overlap), 3e4 * area, 1e-9 * 3e4 * area);
  const double circle = kPi * (r * r - (r - overlap) * (r - overlap));
  EXPECT_NEAR(plane.force(overlap), 3e4 * circle, 1e-9 * 3e4 * circle);
}

TEST(HertzAdhesive, PullsByTheSimplerArea) {
  ContactConstants p = powder();
  p.young_star = 1e-9;
  Contact c(p, Adhesion::Sjkr2, 1e-3, 1e-3);

  EXPECT_NEAR(c.force(1e-5), 3e4 * 4.0 * kPi * 0.5e-3 * 1e-5, 1e-9);
}

TEST(HertzAdhesive, StoresTheWorkThatPressedIt) {
  for (const Adhesion adhesion : {Adhesion::Dmt, Adhesion::Sjkr, Adhesion::Sjkr2}) {
    for (const double other : {0.0, 1e-3, 3e-3}) {
      Contact c(powder(), adhesion, 1e-3, other);
      const int steps = 20000;
      const double deepest = 5e-5;
      double work = 0.0;
      for (int n = 0; n < steps; ++n)
        work -= c.force(deepest * (n + 0.5) / steps) * deepest / steps;

      EXPECT_NEAR(c.energy(deepest), work, 1e-6 * std::fabs(work) + 1e-18)
          << static_cast<int>(adhesion) << " " << other;
    }
  }
}

TEST(HertzAdhesive, CountsThePullInFrictionByDmtAlone) {
  ContactConstants p = powder();
  p.mu = 0.5;
  const double pull = 4.0 * kPi * 0.05 * 0.5e-3;
  for (const Adhesion adhesion : {Adhesion::Dmt, Adhesion::Sjkr2}) {
    Contact c(p, adhesion, 1e-3, 1e-3);
    State s{};
    s.dx = c.reach - 2e-6;
    s.reach = c.reach;
    s.inverse_mass = 1.0;
    s.inverse_radius = c.inverse_radius;
    s.vy = 100.0;

    const double ft = detail::respond_at<HertzAdhesive, 3>(0, c.row, s, 1.0, c.history).fy;

    const double hertz = 4.0 / 3.0 * p.young_star * std::sqrt(0.5e-3 * 2e-6) * 2e-6;
    const double wanted = 0.5 * (hertz + (adhesion == Adhesion::Dmt ? pull : 0.0));
    EXPECT_NEAR(ft, wanted, 1e-9 * wanted) << static_cast<int>(adhesion);
  }
}

}  // namespace
}  // namespace barchan::test
