#include <barchan/core/kernels/law_table.hpp>

#include <barchan/core/base/error.hpp>
#include <barchan/core/kernels/kernel_set.hpp>

namespace barchan {
namespace {

int highest_level(const ContactTable& contacts) {
  return with_law(contacts.law, [&]<class Law>(Law /*law*/) {
    int level = 0;
    for (const ContactConstants& c : contacts.constants)
      level = std::max(level, static_cast<int>(Law::level(c)));
    return level;
  });
}

}  // namespace

LawTable::LawTable() : law_(listed_law(0)) {}

LawTable::LawTable(const ContactTable& contacts)
    : LawTable(listed_law(contacts.law), highest_level(contacts), contacts.num_materials,
               [&](int a, int b, double* row) {
                 with_law(contacts.law, [&]<class Law>(Law /*law*/) {
                   const ContactConstants null;
                   Law::write(a < 0 ? null : contacts.at(a, b), contacts.rules(), row);
                 });
               }) {}

void LawTable::make_codes() {
  const int n = num_materials_;
  if (n * (n + 1) / 2 > 255) {
    throw InputError("more than 255 pairs of materials", "use at most 22 materials");
  }
  rows_.assign(static_cast<std::size_t>(1 + n * (n + 1) / 2) * LawView::kRow, 0.0);
  codes_.assign(static_cast<std::size_t>(n * n), kBonded);
  std::uint8_t code = kBonded;
  for (int a = 0; a < n; ++a) {
    for (int b = a; b < n; ++b)
      codes_[static_cast<std::size_t>(a * n + b)] = codes_[static_cast<std::size_t>(b * n + a)] =
          ++code;
  }
}

void LawTable::make_columns() {
  columns_.assign(LawView::kRow * LawView::kColumn, 0.0);
  for (int f = 0; f < law_.num_fields; ++f) {
    double* column = columns_.data() + f * LawView::kColumn;
    // Kernels take what is common lane by lane without a look-up: no lane may lack it.
    if (law_.is_common(f)) std::fill_n(column, int{LawView::kColumn}, rows_[f]);
    for (int c = 0; c < size() && c < LawView::kColumn; ++c)
      column[c] = rows_[c * LawView::kRow + f];
  }
}

}  // namespace barchan
