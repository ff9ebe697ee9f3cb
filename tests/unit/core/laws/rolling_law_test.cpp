#include <barchan/core/laws/rolling.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <barchan/core/kernels/contact_law.hpp>
#include <unit/core/kernel_sample.hpp>

// Laws with rolling springs and twisting, at every width and from either end.

namespace barchan::test {
namespace {

constexpr int kLinear = 2, kHertz = 3;  // places in the list of laws

LawTable rolling_laws(int law, int num_materials, bool twisting) {
  ContactTable table = table_of(num_materials);
  table.law = law;
  table.twisting = twisting;
  for (std::size_t k = 0; k < table.constants.size(); ++k) {
    ContactConstants& c = table.constants[k];
    c.young_star = 1e4 + 1e3 * static_cast<double>(k % 3);
    c.shear_star = 3e3;
    c.alpha = 0.3;
    c.cn.rate = 3.0;
    c.ct.critical = 2.0;
    if (k % 4 == 3) continue;  // one that rolls freely
    c.mu_rolling = 0.1 + 0.1 * static_cast<double>(k % 3);
    c.kr = k % 2 == 0 ? 0.0 : 2e3;
    c.kr_ratio = k % 2 == 0 ? 0.7 : 0.0;
    c.cr = 1.5;
  }
  for (int a = 0; a < num_materials; ++a) {  // the same from either side
    for (int b = 0; b < a; ++b)
      table.constants[static_cast<std::size_t>(a * num_materials + b)] =
          table.constants[static_cast<std::size_t>(b * num_materials + a)];
  }
  return LawTable(table);
}

template <int Dim>
void expect_same_at_any_width(int law, int num_materials, int bits) {
  const LawTable laws = rolling_laws(law, num_materials, Dim == 3 && (bits & 1) != 0);
  const PeriodicBox box = box_of<Dim>((bits & 2) != 0);
  const bool has_bonds = (bits & 4) != 0;
  Sample<Dim> sample(40, 199, laws.size(), 11, history_in<Dim>(law).length);
  for (auto& code : sample.list.code) code = std::max<std::uint8_t>(code, has_bonds ? 0 : 1);
  std::vector<Sample<Dim>> after;
  for (const VectorWidth width : vector_widths()) {
    after.push_back(sample);
    const KernelSet kernels = make_kernels(Dim, width, laws, has_bonds, box);
    for (int n = 0; n < 4; ++n) kernels.pairs(after.back().job(laws, box));
  }
  for (std::size_t w = 1; w < after.size(); ++w) {
    const auto what = fmt::format("{}, law {}, {}D, {} materials, bits {}",
                                  name_of(vector_widths()[w]), law, Dim, num_materials, bits);
    ASSERT_TRUE(same_bits(after[w].force, after[0].force)) << what;
    ASSERT_TRUE(same_values(after[w].list.history, after[0].list.history)) << what;
  }
}

TEST(Rolling, GivesTheSameBitsAtAnyWidth) {
  for (const int num_materials : {1, 2, 5}) {
    for (int bits = 0; bits < 8; ++bits) {
      expect_same_at_any_width<2>(kLinear, num_materials, bits);
      expect_same_at_any_width<3>(kLinear, num_materials, bits);
      expect_same_at_any_width<3>(kHertz, num_materials, bits);
    }
  }
}

template <int Dim>
void expect_mirrored(int law) {
  const LawTable laws = rolling_laws(law, 2, Dim == 3);
  const History form = history_in<Dim>(law);
  Sample<Dim> there(40, 400, laws.size(), 23, form.length), back = there;
  for (std::size_t k = 0; k < 400; ++k) std::swap(back.list.i[k], back.list.j[k]);
  int num_touching = 0, num_apart = 0;
  for (std::size_t k = 0; k < 400; ++k) {
    const auto one_way = forces_of_ends(there, laws, k), other_way = forces_of_ends(back, laws, k);

    ASSERT_EQ(one_way[0], other_way[1]);
    ASSERT_EQ(one_way[1], other_way[0]);
    const auto at = static_cast<std::int64_t>(k);
    for (int c = 0; c < form.length; ++c) {
      ASSERT_EQ(there.list.history_of(at)[c * kBatch],
                form.sign(c, true) * back.list.history_of(at)[c * kBatch]);
    }
    num_touching += one_way[0][0] != 0.0 ? 1 : 0;
    num_apart += one_way[0][Layout<Dim>::kTorque] != one_way[1][Layout<Dim>::kTorque];
  }
  EXPECT_GT(num_touching, 20);
  EXPECT_GT(num_apart, num_touching / 3) << "the torques of the ends should differ";
}

TEST(Rolling, GivesEachEndWhatItGetsWhenTheEndsSwap) {
  expect_mirrored<2>(kLinear);
  expect_mirrored<3>(kLinear);
  expect_mirrored<3>(kHertz);
}

using Law = WithRolling<LinearSpring>;
using State = TurningPair<simd::Scalar, 3>;

/// Spheres of radius 1 and 3 along x, pressed by 0.01, which turn with `turn` against each other.
State turning(const Vec3& turn) {
  State s{};
  s.dx = 3.99;
  s.reach = 4.0;
  s.inverse_mass = 0.25;
  s.inverse_first = 1.0;
  s.inverse_second = 1.0 / 3.0;
  s.inverse_radius = s.inverse_first + s.inverse_second;
  s.turn_x = turn[0], s.turn_y = turn[1], s.turn_z = turn[2];
  return s;
}

struct Contact {
  double row[LawView::kRow] = {};
  double history[Law::kHistory<3>.length] = {};

  explicit Contact(double mu, double mu_rolling, bool twisting) {
    ContactConstants p;
    p.kn = 1e5, p.kt = 4e4, p.mu = mu, p.mu_rolling = mu_rolling;
    Law::write(p, {true, Tangential::Mindlin, twisting}, row);
  }
};

TEST(Rolling, ActsAsACoupleThatRisesToItsLimit) {
  Contact c(0.5, 0.1, false);
  const double radius = 0.75, fn = 1e5 * 0.01;

  PairForces<simd::Scalar, 3> out{};
  const auto respond = [&](double rate) {
    const auto constants = constants_from<Law, simd::Scalar>(
        [&](auto field) { return c.row[decltype(field)::kPlace]; }, FieldsOf<Law>{});
    (void)Law::respond<simd::Scalar, 0>(constants, turning({0.0, rate, 0.0}), 1e-4, c.history, out);
  };

  respond(2.0);
  EXPECT_NEAR(out.first.ty, radius * radius * 4e4 * 2e-4, 1e-9);  // R²·kr·angle, over r_i = 1
  EXPECT_NEAR(out.second.ty, -out.first.ty / 3.0, 1e-9);
  EXPECT_EQ(out.first.fy, 0.0);
  respond(2000.0);
  EXPECT_NEAR(out.first.ty, radius * 0.1 * fn, 1e-6);
  respond(0.0);
  EXPECT_NEAR(out.first.ty, radius * 0.1 * fn, 1e-6) << "the spring was cut back to the limit";
}

TEST(Rolling, TwistsAboutTheNormalUpToItsLimit) {
  const double a = std::sqrt(0.75 * 0.01), fn = 1e5 * 0.01;
  for (const bool twisting : {false, true}) {
    Contact c(0.5, 0.0, twisting);
    const auto constants = constants_from<Law, simd::Scalar>(
        [&](auto field) { return c.row[decltype(field)::kPlace]; }, FieldsOf<Law>{});
    PairForces<simd::Scalar, 3> out{};
    (void)Law::respond<simd::Scalar, 0>(constants, turning({3.0, 0.0, 0.0}), 1e-4, c.history, out);
    EXPECT_NEAR(out.first.tx, twisting ? 0.5 * 4e4 * a * a * 3e-4 : 0.0, 1e-9);

    (void)Law::respond<simd::Scalar, 0>(constants, turning({-1e5, 0.0, 0.0}), 1e-4, c.history, out);

    EXPECT_NEAR(out.first.tx, twisting ? -2.0 / 3.0 * a * 0.5 * fn : 0.0, 1e-6);
    EXPECT_NEAR(out.second.tx, -out.first.tx / 3.0, 1e-9);
  }
}

TEST(Rolling, KeepsNothingOfPairsThatRollFreely) {
  Contact c(0.5, 0.0, false);
  const auto constants = constants_from<Law, simd::Scalar>(
      [&](auto field) { return c.row[decltype(field)::kPlace]; }, FieldsOf<Law>{});
  PairForces<simd::Scalar, 3> out{};

  (void)Law::respond<simd::Scalar, 0>(constants, turning({3.0, 2.0, 1.0}), 1e-4, c.history, out);

  for (const double number : c.history) EXPECT_EQ(number, 0.0);
  EXPECT_EQ(out.first.ty, 0.0);
}

}  // namespace
}  // namespace barchan::test
