#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <barchan/core/io/vtp.hpp>
#include <barchan/core/model/model.hpp>

namespace barchan {

/// Bonds as the lines of a snapshot: id_a, id_b (Int64), type (Int32, from 1), length,
/// shear_force (3), bending_moment (3), twisting_moment.
class BondLines {
 public:
  /// @param a, b  the two ends of the line [m]
  void add(const BondData& bond, const Vec3& a, const Vec3& b);

  /// Of this object, which lives longer.
  [[nodiscard]] VtpArrays arrays(std::int64_t step, double time) const;

 private:
  std::vector<double> points_, length_, shear_, bending_, twisting_;
  std::vector<std::int64_t> id_a_, id_b_;
  std::vector<std::int32_t> type_;
};

}  // namespace barchan
