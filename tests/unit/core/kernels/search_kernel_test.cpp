#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include <barchan/core/kernels/kernel_set.hpp>
#include <barchan/core/search/contact_search.hpp>

namespace barchan::test {
namespace {

constexpr int kRows = 61;

/// Random rows, axis by axis, the first of them row `first`.
Planes random_planes(std::int32_t first) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> place(0.0, 4.0), size(0.1, 0.5);
  Planes planes;
  planes.first = first;
  for (auto& axis : planes.axis) axis.assign(kRows + kBatch, 0.0);
  planes.radius.assign(kRows + kBatch, 100.0);  // whatever lies behind the end must not be found
  for (std::size_t q = 0; q < kRows; ++q) {
    for (auto& axis : planes.axis) axis[q] = place(random);
    planes.radius[q] = size(random);
  }
  return planes;
}

double distance2(const SearchJob& job, int dim, std::size_t q) {
  double sum = 0.0;
  for (int c = 0; c < dim; ++c) {
    double d = job.x[c][q] - job.at[c];
    d -= job.box.length[c] * std::rint(d * job.box.inverse[c]);
    sum += d * d;
  }
  return sum;
}

std::vector<std::int32_t> by_definition(const SearchJob& job, int dim,
                                        std::span<const Rows> ranges) {
  std::vector<std::int32_t> found;
  for (const Rows rows : ranges) {
    for (std::int32_t j = rows.begin; j < rows.end; ++j) {
      const auto q = static_cast<std::size_t>(j - job.first);
      const double reach = job.radius[q] + job.reach;
      if (distance2(job, dim, q) < reach * reach) found.push_back(j);
    }
  }
  return found;
}

TEST(SearchKernel, FindsWhatIsWithinReachAtEveryWidthAndForAllRanges) {
  const Planes planes = random_planes(5);
  for (const int dim : {2, 3}) {
    for (const bool periodic : {false, true}) {
      SearchJob job;
      for (int c = 0; c < 3; ++c) job.x[c] = planes.axis[c].data();
      job.radius = planes.radius.data();
      job.first = planes.first;
      job.reach = 0.6;
      if (periodic) job.wraps = true, job.box.length[0] = 4.0, job.box.inverse[0] = 0.25;
      job.at[0] = 0.2, job.at[1] = 2.0, job.at[2] = 1.5;
      LawTable laws;
      for (const VectorWidth width : vector_widths()) {
        const SearchKernel search = make_kernels(dim, width, laws, false, job.box).search;
        for (std::int32_t begin = 5; begin < 5 + kRows; begin += 3) {
          for (std::int32_t end = begin; end <= 5 + kRows; ++end) {
            const std::array ranges{Rows{5, 5 + begin / 4}, Rows{begin, begin}, Rows{begin, end}};
            std::vector<std::int32_t> found(2 * kRows + kBatch);
            found.resize(static_cast<std::size_t>(search(job, ranges.data(), 3, found.data())));
            ASSERT_EQ(found, by_definition(job, dim, ranges))
                << dim << "D, " << name_of(width) << ", rows " << begin << " to " << end;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace barchan::test
