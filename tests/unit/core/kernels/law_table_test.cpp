#include <barchan/core/kernels/law_table.hpp>

#include <gtest/gtest.h>

#include <limits>

#include <barchan/core/base/error.hpp>

#include <unit/core/lane_fixture.hpp>

namespace barchan::test {
namespace {

TEST(LawTable, GivesAPairOneCodeWhicheverComesFirst) {
  const LawTable laws(table_of(3));

  EXPECT_EQ(laws.size(), 7);
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      EXPECT_EQ(laws.code(a, b), laws.code(b, a));
      EXPECT_NE(laws.code(a, b), LawTable::kBonded);
      EXPECT_EQ(laws.row(laws.code(a, b))[LinearSpring::Kn], 1e4 + 1e3 * (a + b));
    }
  }
}

TEST(LawTable, NullLawActsNowhere) {
  const LawTable laws(table_of(2));
  for (const auto f : {LinearSpring::Kn, LinearSpring::Kt, LinearSpring::InverseKt,
                       LinearSpring::Mu, LinearSpring::Cn, LinearSpring::Ct}) {
    EXPECT_EQ(laws.view().rows[f], 0.0);
  }
}

TEST(LawTable, ColumnsRepeatRowsAndEveryLaneHasTheCap) {
  for (const bool no_tension : {true, false}) {
    const LawTable laws(table_of(2, no_tension));
    const LawView view = laws.view();
    const double cap = no_tension ? 0.0 : std::numeric_limits<double>::infinity();
    for (int c = 0; c < LawView::kColumn; ++c)
      EXPECT_EQ(view.columns[LinearSpring::Cap * LawView::kColumn + c], cap);
    for (int c = 0; c < view.size; ++c) {
      for (int f = 0; f < LinearSpring::kNumFields; ++f) {
        EXPECT_EQ(view.columns[f * LawView::kColumn + c], view.rows[c * LawView::kRow + f]);
      }
    }
  }
}

TEST(LawTable, WithoutTangentialStiffnessHasNoInverse) {
  ContactTable table = table_of(1);
  table.constants[0].kt = 0.0;
  EXPECT_EQ(LawTable(table).row(1)[LinearSpring::InverseKt], 0.0);
}

TEST(LawTable, RefusesMoreMaterialsThanCodes) {
  EXPECT_EQ(LawTable(table_of(22)).size(), 254);
  EXPECT_THROW(LawTable(table_of(23)), InputError);
}

}  // namespace
}  // namespace barchan::test
