#include <barchan/core/kernels/kernel_set.hpp>

#include <algorithm>

#include <barchan/core/error.hpp>
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
  throw InputError("vector width '" + name + "' is not to be had on this machine",
                   "it has: auto, " + known);
}

namespace {

PairKernel pick_pairs(int dim, VectorWidth width, int variant) {
#ifdef BARCHAN_HAS_X86_KERNELS
  if (width == VectorWidth::Avx512) return kernels::pick_avx512(dim, variant);
  if (width == VectorWidth::Avx2) return kernels::pick_avx2(dim, variant);
#endif
  (void)width;
  return kernels::pick_scalar(dim, variant);
}

NarrowKernel pick_narrow(int dim, VectorWidth width, bool periodic) {
#ifdef BARCHAN_HAS_X86_KERNELS
  if (width == VectorWidth::Avx512) return kernels::pick_narrow_avx512(dim, periodic);
  if (width == VectorWidth::Avx2) return kernels::pick_narrow_avx2(dim, periodic);
#endif
  (void)width;
  return kernels::pick_narrow_scalar(dim, periodic);
}

SearchKernel pick_search_kernel(int dim, VectorWidth width, bool periodic) {
#ifdef BARCHAN_HAS_X86_KERNELS
  if (width == VectorWidth::Avx512) return kernels::pick_search_avx512(dim, periodic);
  if (width == VectorWidth::Avx2) return kernels::pick_search_avx2(dim, periodic);
#endif
  (void)width;
  return kernels::pick_search_scalar(dim, periodic);
}

RowKernel pick_row_kernel(int dim, VectorWidth width, bool damped) {
#ifdef BARCHAN_HAS_X86_KERNELS
  if (width != VectorWidth::Scalar) return kernels::pick_rows_avx2(dim, damped);
#endif
  (void)width;
  return kernels::pick_rows_scalar(dim, damped);
}

}  // namespace

KernelSet make_kernels(int dim, VectorWidth width, const LawTable& laws, bool has_bonds,
                       const PeriodicBox& box) {
  int variant = static_cast<int>(laws.damping());
  if (box.any()) variant |= kernels::kPeriodic;
  if (laws.size() == 2 && !has_bonds) variant |= kernels::kOneLaw;
  // In 2D almost every candidate of a packing touches; in 3D about half do.
  const NarrowKernel narrow = dim == 3 ? pick_narrow(dim, width, box.any()) : nullptr;
  return {width,
          pick_pairs(dim, width, variant),
          pick_pairs(dim, width, variant | kernels::kKeep),
          narrow,
          pick_search_kernel(dim, width, box.any()),
          pick_row_kernel(dim, width, false),
          pick_row_kernel(dim, width, true)};
}

}  // namespace barchan
