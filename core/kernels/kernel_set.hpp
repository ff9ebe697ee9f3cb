#pragma once

#include <string>
#include <vector>

#include <barchan/core/kernels/law_table.hpp>
#include <barchan/core/kernels/pair_job.hpp>
#include <barchan/core/kernels/row_job.hpp>
#include <barchan/core/kernels/search_job.hpp>

namespace barchan {

/// The kernels of a run: one binary, the width chosen when it starts, the same bits at any width.
struct KernelSet {
  VectorWidth width = VectorWidth::Scalar;
  PairKernel pairs = nullptr;
  NarrowKernel narrow = nullptr;  ///< null where testing every candidate in `pairs` is cheaper
  SearchKernel search = nullptr;
  RowKernel rows = nullptr;
  RowKernel rows_damped = nullptr;  ///< with local damping
};

/// Widths this machine has, narrowest first: scalar, avx2, avx512.
std::vector<VectorWidth> vector_widths();
std::string name_of(VectorWidth width);
/// The widest for "auto". Throws InputError for an unknown width or one the machine lacks, with
/// those it has.
VectorWidth vector_width(const std::string& name);

/// A law of the list (laws.hpp).
[[nodiscard]] ContactLaw listed_law(int place);

/// @param has_bonds  some pairs have the null law, so that constants must be looked up pair by pair
KernelSet make_kernels(int dim, VectorWidth width, const LawTable& laws, bool has_bonds,
                       const PeriodicBox& box);

}  // namespace barchan
