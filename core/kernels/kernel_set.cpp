#include <barchan/core/kernels/kernel_set.hpp>

#include <algorithm>

#include <barchan/core/base/error.hpp>
#include <barchan/core/kernels/narrow_loop.hpp>
#include <barchan/core/kernels/pair_loop.hpp>
#include <barchan/core/kernels/row_loop.hpp>
#include <barchan/core/kernels/search_loop.hpp>

namespace barchan {

std::vector<VectorWidth> vector_widths() {
  std::vector<VectorWidth> widths{VectorWidth::Scalar};
#ifdef BARCHAN_HAS_X86_KERNELS
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    widths.push_back(VectorWidth::Avx2);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw")) {
    widths.push_back(VectorWidth::Avx512);
  }
#endif
  return widths;
}

std::string name_of(VectorWidth width) {
  if (width == VectorWidth::Avx512) return "avx512";
  return width == VectorWidth::Avx2 ? "avx2" : "scalar";
}

VectorWidth vector_width(const std::string& name) {
  const auto widths = vector_widths();
  if (name == "auto") return widths.back();
  std::string known;
  for (const VectorWidth width : widths) {
    if (name == name_of(width)) return width;
    known += (known.empty() ? "" : ", ") + name_of(width);
  }
  throw InputError("this machine does not support vector width '" + name + "'",
                   "it supports: auto, " + known);
}

namespace {

/// Who picks the kernels of one width.
struct Pickers {
  NarrowKernel (*narrow)(int dim, bool periodic);
  SearchKernel (*search)(int dim);
  RowKernel (*rows)(int dim, bool damped);
};

Pickers pickers_of(VectorWidth width) {
  using namespace kernels;
#ifdef BARCHAN_HAS_X86_KERNELS
  if (width == VectorWidth::Avx512) return {pick_narrow_avx512, pick_search_avx512, pick_rows_avx2};
  if (width == VectorWidth::Avx2) return {pick_narrow_avx2, pick_search_avx2, pick_rows_avx2};
#endif
  (void)width;
  return {pick_narrow_scalar, pick_search_scalar, pick_rows_scalar};
}

template <class Law>
PairKernel pair_kernel(VectorWidth width, int dim, int variant) {
  using namespace kernels;
#ifdef BARCHAN_HAS_X86_KERNELS
  if (width == VectorWidth::Avx512) return pick_avx512<Law>(dim, variant);
  if (width == VectorWidth::Avx2) return pick_avx2<Law>(dim, variant);
#endif
  (void)width;
  return pick_scalar<Law>(dim, variant);
}

}  // namespace

ContactLaw listed_law(int place) {
  return with_law(place,
                  []<class Law>(Law /*law*/) { return contact_law<Law>(&pair_kernel<Law>); });
}

KernelSet make_kernels(int dim, VectorWidth width, const LawTable& laws, bool has_bonds,
                       const PeriodicBox& box) {
  int variant = laws.level();
  if (box.any()) variant |= kernels::kPeriodic;
  if (laws.size() == 2 && !has_bonds) variant |= kernels::kOneRow;
  const Pickers pick = pickers_of(width);
  // In 2D almost every candidate of a packing touches; in 3D about half do.
  return {width,
          laws.law().kernel(width, dim, variant),
          dim == 3 ? pick.narrow(dim, box.any()) : nullptr,
          pick.search(dim),
          pick.rows(dim, false),
          pick.rows(dim, true)};
}

}  // namespace barchan
