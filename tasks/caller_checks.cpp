#include <barchan/tasks/caller_checks.hpp>

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>

namespace barchan {

bool are_finite(std::span<const double> values) {
  constexpr std::size_t kWidth = 8;  // chains of additions that do not wait for each other
  double sums[kWidth] = {};          // of zeros, or not a number
  std::size_t k = 0;
  for (; k + kWidth <= values.size(); k += kWidth)
    for (std::size_t c = 0; c < kWidth; ++c) sums[c] += 0.0 * values[k + c];
  for (; k < values.size(); ++k) sums[0] += 0.0 * values[k];
  return std::all_of(std::begin(sums), std::end(sums), [](double sum) { return sum == 0.0; });
}

void require_same(const Communicator& communicator, const char* call, const Vec3& values) {
  double both[6];
  for (int c = 0; c < 3; ++c) {
    both[c] = values[c];
    both[3 + c] = -values[c];
  }
  if (communicator.any_of(!are_finite(both)))
    throw InputError(fmt::format("Simulation::{}: a number is not finite", call), "");
  communicator.allreduce_max(std::span<double>(both));
  for (int c = 0; c < 3; ++c) {
    if (both[c] != -both[3 + c])
      throw InputError(fmt::format("Simulation::{}: ranks give different values", call),
                       "give the same on every rank");
  }
}

void require_plane(const Model& model, const char* call, const Vec3& v) {
  if (model.dimension == 2 && v[2] != 0.0)
    throw InputError(fmt::format("Simulation::{}: {} along z leaves the plane", call, v[2]),
                     "give 0 in 2D");
}

std::string differing_lists(const Communicator& communicator,
                            std::initializer_list<std::uint64_t> hashes) {
  bool differs = false;
  for (const std::uint64_t mine : hashes) {
    std::uint64_t first = mine;
    communicator.bcast(std::as_writable_bytes(std::span(&first, 1)));
    differs = differs || first != mine;
  }
  return communicator.any_of(differs) ? "ranks give different lists" : "";
}

}  // namespace barchan
