#pragma once

#include <cstdint>
#include <cstdio>
#include <span>
#include <string>

#include <barchan/core/brick/departure.hpp>

namespace barchan {

/// `left_domain.csv`: a row for each particle that left the domain, with `step,id,x,y,z,vx,vy,vz`
/// (2D without z). The file appears with the first row. One rank.
class DepartureTable {
 public:
  /// Rows of an earlier run from `first_step` on are removed. Errors: RunError.
  DepartureTable(std::string path, int dimension, std::int64_t first_step);
  /// Rows are on their way to the disk when it returns. Errors: RunError.
  void append(std::span<const Departure> departures) const;

 private:
  [[nodiscard]] std::string header() const;
  std::string path_;
  int dimension_;
};

}  // namespace barchan
