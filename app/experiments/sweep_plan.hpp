#pragma once

#include <string>
#include <vector>

#include <barchan/app/command_line.hpp>
#include <barchan/app/experiments/axes.hpp>

namespace barchan::app {

/// What a sweep will run, and by which words.
class SweepPlan {
 public:
  /// Reads the deck with every value that varies, and checks all points.
  /// Errors: InputError, as `barchan run` would have at any point.
  explicit SweepPlan(const SweepArguments& arguments);

  [[nodiscard]] const std::vector<Axis>& axes() const { return axes_; }
  [[nodiscard]] const std::vector<Point>& points() const { return points_; }
  [[nodiscard]] const std::string& folder() const { return folder_; }

  /// The words that run a point and write its results into a folder.
  [[nodiscard]] std::vector<std::string> words(const Point& point, const std::string& out) const;
  /// Whether a point needs more threads than this machine has cores.
  [[nodiscard]] bool is_crowded(const Point& point) const;

 private:
  [[nodiscard]] std::vector<std::string> launcher(const Point& point) const;
  void check(const Point& point) const;
  void check_decks() const;

  SweepArguments arguments_;
  std::string folder_, netlab_;
  std::vector<Axis> axes_;
  std::vector<Point> points_;
};

}  // namespace barchan::app
