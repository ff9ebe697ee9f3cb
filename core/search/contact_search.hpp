#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <barchan/core/kernels/law_table.hpp>
#include <barchan/core/kernels/search_job.hpp>
#include <barchan/core/search/bonded_pairs.hpp>
#include <barchan/core/search/cell_index.hpp>
#include <barchan/core/search/pair_list.hpp>

namespace barchan {

/// Positions, within the box, and radii of some rows, axis by axis, as the search reads them.
struct Planes {
  AlignedVector<double> axis[3], radius;  ///< a batch longer than the rows
  std::int32_t first = 0;                 ///< row of the first value

  template <int Dim>
  void write(const Grid<Dim>& grid, const ParticleStore<Dim>& store, Rows rows);
  [[nodiscard]] std::size_t bytes() const;
};

/// What decides whether a pair is a candidate, and which law it gets.
struct SearchRule {
  double beyond = 0.0;  ///< touch: skin, and range of the law [m]
  ContactSearchKind kind = ContactSearchKind::Cells;
  const LawTable* laws = nullptr;
  const BondedPairs* bonded = nullptr;
  SearchKernel kernel = nullptr;
};

/// Candidates: pairs closer than r_i + r_j + SearchRule::beyond, lower row first, sorted by both
/// rows.
/// Pairs of two fixed particles are left out; a bonded pair gets the null law.
///
/// `AllPairs` looks at every pair and is the reference; `Cells` finds the same pairs in linear
/// time.
template <int Dim>
class ContactSearch {
 public:
  /// @param planes  of all rows that are looked for
  ContactSearch(const Grid<Dim>& grid, const ParticleStore<Dim>& store, const Planes& planes,
                const SearchRule& rule);

  /// Appends the candidates of two owned rows; row_begin[i] = first pair of row i.
  void owned(const CellIndex<Dim>& cells, PairList& list,
             std::vector<std::int64_t>& row_begin) const;

  /// Appends the candidates of owned rows and ghosts, owned ones first.
  void across(const CellIndex<Dim>& cells, Rows own, Rows ghosts, PairList& list) const;

 private:
  void scan(SearchJob& job, std::int32_t i, std::span<const Rows> partners, PairList& list,
            std::int64_t& size) const;
  void set_laws(std::int32_t i, PairList& list, std::int64_t begin, std::int64_t end) const;
  [[nodiscard]] std::int64_t leave_fixed_out(PairList& list, std::int64_t begin,
                                             std::int64_t end) const;

  const Grid<Dim>& grid_;
  const ParticleStore<Dim>& store_;
  SearchRule rule_;
  SearchJob job_;
};

extern template class ContactSearch<2>;
extern template class ContactSearch<3>;

}  // namespace barchan
