#include <barchan/core/base/vec_text.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace barchan {

std::string in_brackets(const double* components, int dimension) {
  return fmt::format("({:.6g})", fmt::join(components, components + dimension, ", "));
}

std::string in_brackets(const Vec3& v, int dimension) {
  return in_brackets(v.data(), dimension);
}

}  // namespace barchan
