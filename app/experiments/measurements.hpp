#pragma once

#include <string>
#include <vector>

#include <barchan/app/experiments/axes.hpp>
#include <barchan/app/json_text.hpp>

// What runs that have ended took, from their folders.

namespace barchan::app {

/// A run that has ended.
struct Measurement {
  Point point;
  int repetition = 1;
  double others = 0.0;  ///< cores that other processes used meanwhile; 0 where nobody looked
  std::string folder;   ///< of the run
  Json run;             ///< run.json

  [[nodiscard]] double per_step(double seconds) const;        ///< [µs]
  [[nodiscard]] double step() const;                          ///< [µs], of the slowest rank
  [[nodiscard]] double communication(const char* key) const;  ///< [µs a step], mean of the ranks
  [[nodiscard]] double work() const;    ///< [µs a step]: forces, bands, search
  [[nodiscard]] double hidden() const;  ///< share
  [[nodiscard]] std::string digest() const;
};

struct Experiment {
  std::string path;
  Json sweep;                     ///< sweep.json; null for other folders
  std::vector<Measurement> runs;  ///< point by point, in the order of the sweep

  [[nodiscard]] std::vector<Point> points() const;
  [[nodiscard]] std::vector<const Measurement*> of(const Point& point) const;
};

/// A sweep, the folders of runs in a folder, or one run by its folder or run.json.
/// Errors: InputError where there is no run that has ended.
[[nodiscard]] Experiment read_experiment(const std::string& path);

/// The same with ":AXIS=VALUE,..." behind it, whose runs alone are taken. @return  and those values
struct Selection {
  Experiment experiment;
  Point values;
};
[[nodiscard]] Selection read_selection(const std::string& text);

/// The steps [µs] of some runs.
[[nodiscard]] std::vector<double> steps_of(const std::vector<const Measurement*>& runs);
/// What a function says of each of them.
template <class Figure>
[[nodiscard]] std::vector<double> figures_of(const std::vector<const Measurement*>& runs,
                                             Figure&& figure) {
  std::vector<double> values;
  for (const Measurement* run : runs) values.push_back(figure(*run));
  return values;
}

}  // namespace barchan::app
