#pragma once

namespace barchan {

/// The law table as a kernel sees it (law_table.hpp owns it). Kernel files include no library
/// header: their inline code is compiled for wider machines and must not be shared with the rest of
/// the program.
struct LawView {
  enum Field {
    Kn,
    Kt,
    InverseKt,
    Mu,
    Cap,
    Cn,
    Ct,
    CnRate,
    CtRate,
    CnCritical,
    CtCritical,
    kNumFields
  };
  static constexpr int kRow = 16;    ///< doubles per law in `rows`
  static constexpr int kColumn = 8;  ///< laws that fit a vector register, see `columns`

  const double* rows = nullptr;     ///< law c, field f at rows[c·kRow + f]
  const double* columns = nullptr;  ///< law c < 8, field f at columns[f·kColumn + c]
  int size = 0;
};

}  // namespace barchan
