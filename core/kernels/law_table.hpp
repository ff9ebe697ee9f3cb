#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <barchan/core/kernels/contact_law.hpp>
#include <barchan/core/kernels/law_view.hpp>
#include <barchan/core/model/model.hpp>
#include <barchan/core/particles/layout.hpp>

namespace barchan {

/// The contact law of a run and its constants, one code per unordered pair of materials, laid out
/// for the kernels.
///
/// Code 0 is the null row of a bonded pair: the bond carries everything until it breaks.
class LawTable {
 public:
  static constexpr std::uint8_t kBonded = 0;

  LawTable();  ///< with the first law of the list, for no materials
  /// With the law of the deck. Throws InputError for more than 255 pairs of materials.
  explicit LawTable(const ContactTable& contacts);
  /// With any law. @param write  write(a, b, row) writes the constants of a pair, zero before;
  /// a = b = -1: of the null row
  template <class Write>
  LawTable(const ContactLaw& law, int level, int num_materials, Write&& write)
      : law_(law), level_(level), num_materials_(num_materials) {
    make_codes();
    write(-1, -1, rows_.data());
    for (int a = 0; a < num_materials; ++a) {
      for (int b = a; b < num_materials; ++b)
        write(a, b, rows_.data() + LawView::kRow * code(a, b));
    }
    make_columns();
  }

  [[nodiscard]] const ContactLaw& law() const { return law_; }
  [[nodiscard]] std::uint8_t code(int type_a, int type_b) const {
    return codes_[static_cast<std::size_t>(type_a * num_materials_ + type_b)];
  }
  [[nodiscard]] const double* row(std::uint8_t code) const {
    return rows_.data() + LawView::kRow * code;
  }
  [[nodiscard]] int size() const { return static_cast<int>(rows_.size()) / LawView::kRow; }
  [[nodiscard]] int num_materials() const { return num_materials_; }
  [[nodiscard]] int level() const { return level_; }  ///< that all pairs need, see the law
  /// Valid as long as the table is.
  [[nodiscard]] LawView view() const { return {rows_.data(), columns_.data(), size()}; }

 private:
  void make_codes();
  void make_columns();

  ContactLaw law_;
  int level_ = 0;
  int num_materials_ = 0;
  AlignedVector<double> rows_, columns_;
  std::vector<std::uint8_t> codes_;
};

}  // namespace barchan
