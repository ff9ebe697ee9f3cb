#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>

#include <fmt/format.h>

#include <barchan/app/commands.hpp>
#include <barchan/app/experiments/measurements.hpp>
#include <barchan/app/experiments/programs.hpp>
#include <barchan/app/experiments/sweep_folder.hpp>
#include <barchan/app/experiments/sweep_plan.hpp>
#include <barchan/app/readable.hpp>
#include <barchan/app/warning.hpp>
#include <barchan/core/base/clock.hpp>
#include <barchan/core/base/error.hpp>

namespace fs = std::filesystem;

namespace barchan::app {
namespace {

/// What a run took that ended well, in a line.
std::string figures(const Measurement& m) {
  return fmt::format("{:.4g} µs a step, {} hidden", m.step(), percent(m.hidden()));
}

class Sweep {
 public:
  explicit Sweep(const SweepArguments& arguments)
      : arguments_(arguments), plan_(arguments), folder_(plan_, arguments) {
    varied_ = varied_axes(plan_.points());
    for (int n = 1; n <= arguments.repeat; ++n) add_repetition(n);
  }

  void run() {
    tell_begin();
    for (int n = 1; n <= arguments_.repeat && has_time(); ++n) {
      const std::int64_t begin = now_ns();
      while (num_left() > 0 && runs_[next_].repetition == n && !Programs::is_interrupted())
        run_next();
      longest_round_ = std::max(longest_round_, seconds_since(begin));
    }
    tell_end();
  }

 private:
  struct Run {
    Point point;
    int repetition;
  };

  /// Every second repetition goes the other way.
  void add_repetition(int repetition) {
    std::vector<Point> round = plan_.points();
    if (repetition % 2 == 0) std::reverse(round.begin(), round.end());
    for (const Point& point : round) {
      if (!folder_.is_done(point, repetition)) runs_.push_back({point, repetition});
    }
  }

  [[nodiscard]] std::size_t num_all() const {
    return plan_.points().size() * static_cast<std::size_t>(arguments_.repeat);
  }
  [[nodiscard]] std::size_t num_left() const { return runs_.size() - next_; }

  void tell_begin() const {
    if (arguments_.quiet) return;
    std::fprintf(stderr, "%s: %zu points, %d repetitions; %zu of %zu runs are there\n",
                 plan_.folder().c_str(), plan_.points().size(), arguments_.repeat,
                 num_all() - num_left(), num_all());
    const auto& points = plan_.points();
    if (std::any_of(points.begin(), points.end(), [&](auto& p) { return plan_.is_crowded(p); }))
      print_warning("there are points with more threads than cores: their times are rough");
  }

  [[nodiscard]] bool has_time() const {
    if (arguments_.minutes <= 0.0) return true;
    return seconds_since(begin_) + longest_round_ <= 60.0 * arguments_.minutes;
  }

  void run_next() {
    const auto& [point, repetition] = runs_[next_];
    const std::string out = folder_.run(point, repetition);
    const std::vector<std::string> words = plan_.words(point, out);
    if (::isatty(STDERR_FILENO) != 0 && !arguments_.quiet)
      std::fprintf(stderr, "\r\033[K%s ...", head(point).c_str());
    const OtherWork others;
    const std::int64_t begin = now_ns();
    const int status = programs_.run(words, out + ".log");
    const double seconds = seconds_since(begin);
    if (Programs::is_interrupted()) return;
    ++next_;
    seconds_[text_of(point)] = seconds;
    if (status == 0) {
      folder_.add(point, repetition, {words, seconds, others.cores()});
      tell(point, figures(read_experiment(out).runs.front()));
    } else {
      const std::string why = folder_.last_words(out + ".log");
      failed_.push_back(text_of(point));
      tell(point, fmt::format("failed with status {}: {}", status, why));
    }
  }

  [[nodiscard]] std::string head(const Point& point) const {
    Point shown;
    for (const std::string& axis : varied_) shown.push_back({axis, value_of(point, axis)});
    return fmt::format("{} of {}{}", num_all() - num_left(), num_all(),
                       shown.empty() ? "" : "  " + text_of(shown));
  }

  void tell(const Point& point, const std::string& what) const {
    if (arguments_.quiet) return;
    const char* line_begin = ::isatty(STDERR_FILENO) != 0 ? "\r\033[K" : "";
    const std::string left = num_left() > 0 ? "; " + readable_time(time_left()) + " left" : "";
    std::fprintf(stderr, "%s%s: %s%s\n", line_begin, head(point).c_str(), what.c_str(),
                 left.c_str());
    std::fflush(stderr);
  }

  /// As long as each point took last, and the others as long as the mean of these.
  [[nodiscard]] double time_left() const {
    double sum = 0.0, left = 0.0;
    for (const auto& [name, seconds] : seconds_) sum += seconds;
    const double mean = sum / static_cast<double>(std::max<std::size_t>(1, seconds_.size()));
    for (std::size_t k = next_; k < runs_.size(); ++k) {
      const auto it = seconds_.find(text_of(runs_[k].point));
      left += it == seconds_.end() ? mean : it->second;
    }
    return left;
  }

  void tell_end() const {
    const bool has_any = num_left() + failed_.size() < num_all();
    if (!arguments_.quiet && !Programs::is_interrupted() && has_any)
      print_runs({.path = plan_.folder(), .against = {}, .format = TableFormat::Text});
    if (Programs::is_interrupted())
      throw RunError(fmt::format(
          "the sweep was interrupted with {} runs left; the same command goes on with it",
          num_left()));
    if (!failed_.empty())
      throw RunError(fmt::format(
          "runs failed at {} of {} points, the first at {}; what they said is in {}/runs",
          std::set(failed_.begin(), failed_.end()).size(), plan_.points().size(), failed_.front(),
          plan_.folder()));
  }

  SweepArguments arguments_;
  SweepPlan plan_;
  SweepFolder folder_;
  Programs programs_;
  std::vector<std::string> varied_;
  std::vector<Run> runs_;                  ///< in their order, without those that were there
  std::size_t next_ = 0;                   ///< of runs_
  std::map<std::string, double> seconds_;  ///< that each point took last
  std::vector<std::string> failed_;        ///< the point of each run that failed
  std::int64_t begin_ = now_ns();
  double longest_round_ = 0.0;  ///< [s]
};

}  // namespace

void sweep(const SweepArguments& arguments) {
  // Open MPI wants to be told that root may start it, which in a container is the usual user.
  if (::geteuid() == 0) {
    ::setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 0);
    ::setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 0);
  }
  Sweep sweep(arguments);
  sweep.run();
}

}  // namespace barchan::app
