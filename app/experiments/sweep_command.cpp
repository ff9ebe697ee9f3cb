#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

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
    for (int n = 1; n <= arguments.repeat; ++n) {
      for (const Point& point : plan_.points()) num_left_ += folder_.is_done(point, n) ? 0 : 1;
    }
    num_all_ = static_cast<int>(plan_.points().size()) * arguments.repeat;
  }

  void run() {
    tell_begin();
    for (int n = 1; n <= arguments_.repeat && !Programs::is_interrupted(); ++n) {
      if (!has_time()) break;
      std::vector<Point> round = plan_.points();
      if (n % 2 == 0) std::reverse(round.begin(), round.end());
      const std::int64_t begin = now_ns();
      for (const Point& point : round) {
        if (!Programs::is_interrupted() && !folder_.is_done(point, n)) run_one(point, n);
      }
      last_round_ = std::max(last_round_, seconds_since(begin));
    }
    tell_end();
  }

 private:
  void tell_begin() const {
    if (arguments_.quiet) return;
    std::fprintf(stderr, "%s: %zu points, %d repetitions; %d of %d runs are there\n",
                 plan_.folder().c_str(), plan_.points().size(), arguments_.repeat,
                 num_all_ - num_left_, num_all_);
    const auto& points = plan_.points();
    if (std::any_of(points.begin(), points.end(), [&](auto& p) { return plan_.is_crowded(p); }))
      print_warning("there are points with more threads than cores: their times are rough");
  }

  [[nodiscard]] bool has_time() const {
    if (arguments_.minutes <= 0.0 || last_round_ == 0.0) return true;
    return seconds_since(begin_) + last_round_ <= 60.0 * arguments_.minutes;
  }

  void run_one(const Point& point, int repetition) {
    const std::string out = folder_.run(point, repetition);
    const std::vector<std::string> words = plan_.words(point, out);
    if (::isatty(STDERR_FILENO) != 0 && !arguments_.quiet)
      std::fprintf(stderr, "\r\033[K%s ...", head(point).c_str());
    const OtherWork others;
    const std::int64_t begin = now_ns();
    const Ended ended = programs_.run(words, out + ".log");
    const double seconds = seconds_since(begin);
    if (ended.was_interrupted) return;
    --num_left_;
    seconds_[text_of(point)] = seconds;
    if (ended.status == 0) {
      folder_.add(point, repetition, {words, seconds, others.cores()});
      tell(point, figures(read_experiment(out).runs.front()));
    } else {
      const std::string why = folder_.last_words(out + ".log");
      failed_.insert(text_of(point));
      tell(point, fmt::format("failed with status {}: {}", ended.status, why));
    }
  }

  [[nodiscard]] std::string head(const Point& point) const {
    Point shown;
    for (const std::string& axis : varied_) shown.push_back({axis, value_of(point, axis)});
    const int done = num_all_ - num_left_;
    return fmt::format("{} of {}{}", std::min(num_all_, done), num_all_,
                       shown.empty() ? "" : "  " + text_of(shown));
  }

  void tell(const Point& point, const std::string& what) const {
    if (arguments_.quiet) return;
    const char* line_begin = ::isatty(STDERR_FILENO) != 0 ? "\r\033[K" : "";
    const std::string left = num_left_ > 0 ? "; " + readable_time(time_left()) + " left" : "";
    std::fprintf(stderr, "%s%s: %s%s\n", line_begin, head(point).c_str(), what.c_str(),
                 left.c_str());
    std::fflush(stderr);
  }

  /// As long as each point took last, and the others as long as the mean of these.
  [[nodiscard]] double time_left() const {
    double sum = 0.0, left = 0.0;
    for (const auto& [name, seconds] : seconds_) sum += seconds;
    const double mean = sum / static_cast<double>(std::max<std::size_t>(1, seconds_.size()));
    for (int n = 1; n <= arguments_.repeat; ++n) {
      for (const Point& point : plan_.points()) {
        if (folder_.is_done(point, n)) continue;
        const auto it = seconds_.find(text_of(point));
        left += it == seconds_.end() ? mean : it->second;
      }
    }
    return left;
  }

  void tell_end() const {
    const bool has_any = num_left_ + static_cast<int>(failed_.size()) < num_all_;
    if (!arguments_.quiet && !Programs::is_interrupted() && has_any)
      print_runs({.path = plan_.folder(), .against = {}, .format = TableFormat::Text});
    if (Programs::is_interrupted())
      throw RunError(fmt::format(
          "the sweep was interrupted with {} runs left; the same command goes on with it",
          num_left_));
    if (!failed_.empty())
      throw RunError(fmt::format(
          "runs failed at {} of {} points, the first at {}; what they said is in {}/runs",
          failed_.size(), plan_.points().size(), *failed_.begin(), plan_.folder()));
  }

  SweepArguments arguments_;
  SweepPlan plan_;
  SweepFolder folder_;
  Programs programs_;
  std::vector<std::string> varied_;
  std::map<std::string, double> seconds_;  ///< that each point took last
  std::set<std::string> failed_;
  std::int64_t begin_ = now_ns();
  double last_round_ = 0.0;
  int num_all_ = 0, num_left_ = 0;
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
