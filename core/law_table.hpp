#pragma once

#include <cstdint>
#include <vector>

#include <barchan/core/contact_law.hpp>
#include <barchan/core/kernels/law_view.hpp>
#include <barchan/core/layout.hpp>
#include <barchan/core/model.hpp>

namespace barchan {

/// The contact laws of a run, one code per unordered pair of materials, laid out for the kernels.
///
/// Code 0 is the null law of a bonded pair: the bond carries everything until it breaks.
class LawTable {
 public:
  static constexpr std::uint8_t kBonded = 0;

  LawTable() = default;
  /// Throws InputError for more than 255 pairs of materials.
  explicit LawTable(const ContactTable& contacts);

  [[nodiscard]] std::uint8_t code(int type_a, int type_b) const {
    return codes_[static_cast<std::size_t>(type_a * num_materials_ + type_b)];
  }
  [[nodiscard]] int size() const { return static_cast<int>(rows_.size()) / LawView::kRow; }
  [[nodiscard]] int num_materials() const { return num_materials_; }
  [[nodiscard]] Damping damping() const { return damping_; }  ///< what some dashpot depends on
  /// Valid as long as the table is.
  [[nodiscard]] LawView view() const { return {rows_.data(), columns_.data(), size()}; }

 private:
  void add(const ContactConstants& constants, double cap);

  int num_materials_ = 0;
  Damping damping_ = Damping::Constant;
  AlignedVector<double> rows_, columns_;
  std::vector<std::uint8_t> codes_;
};

}  // namespace barchan
