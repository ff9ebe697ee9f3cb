#pragma once

#include <string>
#include <vector>

#include <barchan/app/command_line.hpp>
#include <barchan/app/experiments/axes.hpp>
#include <barchan/app/experiments/sweep_plan.hpp>

namespace barchan::app {

/// A run that ended well.
struct RunRecord {
  std::vector<std::string> words;  ///< that started it
  double seconds = 0.0;            ///< from its start to its end
  double others = 0.0;             ///< cores that other processes used meanwhile
};

/// The folder of a sweep:
///
///     sweep.json             the deck as it was, its settings, the axes
///     runs/POINT/1/          the folder of a run: run.json, series.csv, ...
///     runs/POINT/1.json      the point, its command line, how busy the machine was; written last
///     runs/POINT/1.log       what a run said that failed
class SweepFolder {
 public:
  /// Makes the folder or goes on with it. Errors: InputError where it is not of a sweep, or of one
  /// of another deck or other settings and may not be replaced.
  SweepFolder(const SweepPlan& plan, const SweepArguments& arguments);

  [[nodiscard]] std::string run(const Point& point, int repetition) const;
  [[nodiscard]] bool is_done(const Point& point, int repetition) const;
  /// Keeps a run's results, without snapshots unless they are wanted.
  void add(const Point& point, int repetition, const RunRecord& record) const;

  /// What a run complained of, or the end of all it said.
  [[nodiscard]] static std::string last_words(const std::string& log);

 private:
  void check(const SweepArguments& arguments) const;

  std::string path_;
  bool keeps_;
};

}  // namespace barchan::app
