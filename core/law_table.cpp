#include <barchan/core/law_table.hpp>

#include <algorithm>
#include <limits>

#include <barchan/core/error.hpp>

namespace barchan {

LawTable::LawTable(const ContactTable& contacts) : num_materials_(contacts.num_materials) {
  const int n = num_materials_;
  if (n * (n + 1) / 2 > 255) {
    throw InputError("more than 255 pairs of materials", "use at most 22 materials");
  }
  const double cap = contacts.no_tension ? 0.0 : std::numeric_limits<double>::infinity();
  add(ContactConstants{}, cap);
  codes_.assign(static_cast<std::size_t>(n * n), kBonded);
  for (int a = 0; a < n; ++a) {
    for (int b = a; b < n; ++b) {
      const auto code = static_cast<std::uint8_t>(size());
      add(contacts.at(a, b), cap);
      codes_[static_cast<std::size_t>(a * n + b)] = codes_[static_cast<std::size_t>(b * n + a)] =
          code;
    }
  }
  columns_.assign(LawView::kNumFields * LawView::kColumn, 0.0);
  // All laws have the same cap, and kernels take it lane by lane without a look-up: no lane may
  // lack it.
  std::fill_n(columns_.begin() + LawView::Cap * LawView::kColumn, int{LawView::kColumn}, cap);
  for (int c = 0; c < size() && c < LawView::kColumn; ++c) {
    for (int f = 0; f < LawView::kNumFields; ++f)
      columns_[f * LawView::kColumn + c] = rows_[c * LawView::kRow + f];
  }
}

void LawTable::add(const ContactConstants& k, double cap) {
  double row[LawView::kRow] = {};
  row[LawView::Kn] = k.kn;
  row[LawView::Kt] = k.kt;
  row[LawView::InverseKt] = k.kt > 0.0 ? 1.0 / k.kt : 0.0;
  row[LawView::Mu] = k.mu;
  row[LawView::Cap] = cap;
  row[LawView::Cn] = k.cn.constant;
  row[LawView::Ct] = k.ct.constant;
  row[LawView::CnRate] = k.cn.rate;
  row[LawView::CtRate] = k.ct.rate;
  row[LawView::CnCritical] = k.cn.critical;
  row[LawView::CtCritical] = k.ct.critical;
  // A null law keeps no spring: with mu = 0 every contact slides, and 0·inverse_kt = 0 clears it.
  if (k.cn.critical > 0 || k.ct.critical > 0)
    damping_ = Damping::Critical;
  else if (damping_ == Damping::Constant && (k.cn.rate > 0 || k.ct.rate > 0))
    damping_ = Damping::Rate;
  rows_.insert(rows_.end(), row, row + LawView::kRow);
}

}  // namespace barchan
