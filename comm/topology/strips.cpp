#include <barchan/comm/topology/strips.hpp>

#include <algorithm>
#include <stdexcept>
#include <string>

#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

constexpr double kToleratedImbalance = 1.03;
constexpr double kLeastGain = 0.01;  // of the largest load: moving cuts moves particles

// sums[s] = particles in the slabs before s. Where nobody is, slabs count one each.
std::vector<std::int64_t> prefix_sums(std::span<const std::int64_t> counts) {
  const bool is_empty =
      std::all_of(counts.begin(), counts.end(), [](std::int64_t count) { return count == 0; });
  std::vector<std::int64_t> sums(counts.size() + 1, 0);
  for (std::size_t slab = 0; slab < counts.size(); ++slab)
    sums[slab + 1] = sums[slab] + (is_empty ? 1 : counts[slab]);
  return sums;
}

// The cut in [lowest, highest] where `sums` is nearest to `part` / `num_parts` of the total; the
// lower one of equals.
int nearest_cut(const std::vector<std::int64_t>& sums, int part, int num_parts, int lowest,
                int highest) {
  const auto distance = [&](int cut) {
    const auto have = static_cast<long double>(sums[static_cast<std::size_t>(cut)]) * num_parts;
    const auto want = static_cast<long double>(sums.back()) * part;
    return have > want ? have - want : want - have;
  };
  const auto target =
      static_cast<std::int64_t>(static_cast<long double>(sums.back()) * part / num_parts);
  const auto above = std::lower_bound(sums.begin() + lowest, sums.begin() + highest, target);
  const int upper = static_cast<int>(above - sums.begin());
  int best = upper;
  for (int cut = std::max(lowest, upper - 1); cut <= std::min(highest, upper + 1); ++cut) {
    if (distance(cut) < distance(best) || (distance(cut) == distance(best) && cut < best))
      best = cut;
  }
  return best;
}

std::int64_t largest_load(std::span<const int> cuts, const std::vector<std::int64_t>& sums) {
  std::int64_t largest = 0;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    largest = std::max(largest, sums[static_cast<std::size_t>(cuts[i + 1])] -
                                    sums[static_cast<std::size_t>(cuts[i])]);
  }
  return largest;
}

}  // namespace

int max_strips(int num_slabs, int min_slabs) {
  return std::max(1, num_slabs / std::max(1, min_slabs));
}

std::vector<int> cut_equal(std::span<const std::int64_t> load_of_slab, int num_strips,
                           int min_slabs) {
  const int num_slabs = static_cast<int>(load_of_slab.size());
  if (num_strips > 1 && num_strips > max_strips(num_slabs, min_slabs)) {
    throw InputError(std::to_string(num_strips) + " ranks are more than the domain has strips of " +
                         std::to_string(min_slabs) + " cells (" + std::to_string(num_slabs) +
                         " cells along the strip axis)",
                     "use at most " + std::to_string(max_strips(num_slabs, min_slabs)) + " ranks");
  }
  const auto sums = prefix_sums(load_of_slab);
  std::vector<int> cuts(static_cast<std::size_t>(num_strips) + 1, 0);
  cuts.back() = num_slabs;
  for (int i = 1; i < num_strips; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const int lowest = cuts[at - 1] + min_slabs;
    const int highest = num_slabs - (num_strips - i) * min_slabs;
    cuts[at] = nearest_cut(sums, i, num_strips, lowest, highest);
  }
  return cuts;
}

std::vector<int> recut(std::span<const int> old_cuts, std::span<const std::int64_t> load_of_slab,
                       int num_strips, int min_slabs) {
  const int num_slabs = static_cast<int>(load_of_slab.size());
  if (old_cuts.size() != static_cast<std::size_t>(num_strips) + 1 || old_cuts.back() != num_slabs) {
    throw std::logic_error("recut: the old cuts belong to another grid or number of strips");
  }
  std::vector<int> cuts(old_cuts.begin(), old_cuts.end());
  if (imbalance(old_cuts, load_of_slab) <= kToleratedImbalance) return cuts;

  const auto sums = prefix_sums(load_of_slab);
  for (int i = 1; i < num_strips; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const int lowest = std::max(old_cuts[at - 1] + 1, cuts[at - 1] + min_slabs);
    const int highest = std::min(old_cuts[at + 1] - 1, num_slabs - (num_strips - i) * min_slabs);
    cuts[at] = nearest_cut(sums, i, num_strips, lowest, highest);
  }
  const auto before = static_cast<double>(largest_load(old_cuts, sums));
  if (static_cast<double>(largest_load(cuts, sums)) > (1.0 - kLeastGain) * before)
    return {old_cuts.begin(), old_cuts.end()};
  return cuts;
}

double imbalance(std::span<const int> cuts, std::span<const std::int64_t> load_of_slab) {
  if (std::all_of(load_of_slab.begin(), load_of_slab.end(),
                  [](std::int64_t count) { return count == 0; })) {
    return 1.0;
  }
  const auto sums = prefix_sums(load_of_slab);
  const double mean = static_cast<double>(sums.back()) / static_cast<double>(cuts.size() - 1);
  return static_cast<double>(largest_load(cuts, sums)) / mean;
}

int strip_of(std::span<const int> cuts, int slab) {
  const auto above = std::upper_bound(cuts.begin(), cuts.end(), slab);
  return static_cast<int>(above - cuts.begin()) - 1;
}

}  // namespace barchan
