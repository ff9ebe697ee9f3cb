#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include <fmt/format.h>

#include <barchan/app/commands.hpp>
#include <barchan/app/json_text.hpp>
#include <barchan/app/readable.hpp>
#include <barchan/app/run_view.hpp>
#include <barchan/app/terminal.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/core/base/host_name.hpp>
#include <barchan/core/io/text_file.hpp>
#include <barchan/tasks/results/run_folder.hpp>

namespace fs = std::filesystem;

namespace barchan::app {
namespace {

/// What a file says now; nothing where it is gone, as it may be at any time.
std::string text_now(const std::string& path) {
  try {
    return fs::exists(path) ? read_text_file(path) : "";
  } catch (const std::exception&) {
    return {};
  }
}

/// Whether a run holds a folder, as far as anybody can tell from this host.
bool is_running(const std::string& folder) {
  const std::string text = text_now(folder + "/" + kLockName);
  LineReader lines(text, kLockName);
  std::string_view line;
  std::string host;
  long pid = 0;
  while (lines.next(line)) {
    const std::string_view word = take_word(line);
    if (word == "host") host = std::string(trimmed(line));
    if (word == "pid") pid = std::strtol(std::string(trimmed(line)).c_str(), nullptr, 10);
  }
  if (pid <= 0) return false;
  return host != host_name() || ::kill(static_cast<pid_t>(pid), 0) == 0 || errno == EPERM;
}

/// The last whole row of a series, by the names of its columns.
Json last_row(const std::string& path) {
  const std::string text = text_now(path);
  LineReader lines(std::string_view(text).substr(0, text.rfind('\n') + 1), path);
  std::string_view line, head, last;
  if (!lines.next(head)) return Json::object();
  while (lines.next(line)) last = line;
  Json row = Json::object();
  const auto cut = [](std::string_view& rest) {
    const auto comma = rest.find(',');
    const std::string word(rest.substr(0, comma));
    rest.remove_prefix(comma == std::string_view::npos ? rest.size() : comma + 1);
    return word;
  };
  while (!head.empty() && !last.empty()) {
    const std::string name = cut(head), value = cut(last);
    row[name] = std::strtod(value.c_str(), nullptr);
  }
  return row;
}

std::string bar(double share) {
  constexpr int kWidth = 30;
  const int full = static_cast<int>(kWidth * std::clamp(share, 0.0, 1.0));
  return "[" + std::string(static_cast<std::size_t>(full), '#') +
         std::string(static_cast<std::size_t>(kWidth - full), '-') + "]";
}

void add_progress(const Json& p, Rows& rows) {
  const double steps = std::max(1.0, number_in(p, "steps")), share = number_in(p, "step") / steps;
  rows.push_back(
      {"step",
       fmt::format("{} of {}  {} {}", grouped(static_cast<std::int64_t>(number_in(p, "step"))),
                   grouped(static_cast<std::int64_t>(steps)), bar(share), percent(share))});
  rows.push_back({"left", fmt::format("{} after {}", readable_time(number_in(p, "seconds_left")),
                                      readable_time(number_in(p, "seconds")))});
  const double per_step = number_in(p, "loop_seconds") / std::max(1.0, number_in(p, "loop_steps"));
  if (per_step > 0.0)
    rows.push_back(
        {"rate", fmt::format("{} a step, {} particle-steps/s", readable_seconds(per_step),
                             readable_rate(number_in(p, "particles") / per_step))});
  const double flight = number_in(p, "in_flight_seconds"),
               exposed = number_in(p, "exposed_seconds");
  if (flight > 0.0)
    rows.push_back(
        {"hidden",
         fmt::format("{} of communication, {} a step exposed, on rank 0 of {}",
                     percent(std::clamp(1.0 - exposed / flight, 0.0, 1.0)),
                     readable_seconds(exposed / std::max(1.0, number_in(p, "loop_steps"))),
                     grouped(static_cast<std::int64_t>(number_in(p, "ranks"))))});
}

void add_state(const Json& row, Rows& rows) {
  if (!row.contains("step")) return;
  rows.push_back(
      {"energy", fmt::format("kinetic {:.4g} J, elastic {:.4g} J at step {}",
                             number_in(row, "kinetic_energy"), number_in(row, "elastic_energy"),
                             grouped(static_cast<std::int64_t>(number_in(row, "step"))))});
  rows.push_back(
      {"state", fmt::format("{} contacts, largest overlap {:.3g} m",
                            grouped(static_cast<std::int64_t>(number_in(row, "contacts"))),
                            number_in(row, "max_overlap"))});
}

/// Looks at a run again and again, and draws over what it drew before on a terminal.
class Watcher {
 public:
  explicit Watcher(const WatchArguments& arguments)
      : arguments_(arguments), is_terminal_(::isatty(STDOUT_FILENO) != 0) {}

  void look() {
    const std::string& folder = arguments_.path;
    const Json progress = parsed(text_now(folder + "/progress.json"));
    Rows rows;
    if (progress.is_object())
      add_progress(progress, rows);
    else
      rows.push_back({"step", "it has just begun"});
    add_state(last_row(folder + "/series.csv"), rows);
    rows = wrapped_within(rows, columns_of(STDOUT_FILENO));
    if (is_terminal_ && num_lines_ > 0) std::printf("\033[%zuA\033[J", num_lines_);
    std::fputs(table(rows, 2).c_str(), stdout);
    std::fflush(stdout);
    num_lines_ = rows.size();
  }

 private:
  WatchArguments arguments_;
  bool is_terminal_;
  std::size_t num_lines_ = 0;
};

}  // namespace

void watch(const WatchArguments& arguments) {
  const std::string& folder = arguments.path;
  const std::string ended = folder + "/run.json";
  if (!fs::exists(folder + "/" + kLockName) && !fs::exists(ended) &&
      !fs::exists(folder + "/series.csv"))
    throw InputError(SourcePlace{folder, 0, 0}, "is not a folder of a run",
                     "give the folder of a run that has begun");
  std::printf("%s\n", folder.c_str());
  Watcher watcher(arguments);
  while (is_running(folder)) {
    watcher.look();
    if (arguments.once) return;
    std::this_thread::sleep_for(std::chrono::duration<double>(arguments.interval));
  }
  const std::string text = text_now(ended);
  if (text.empty())
    throw RunError(
        fmt::format("{}: the run died; --restart auto continues from its last checkpoint, "
                    "if there is one",
                    folder));
  std::printf("It has ended:\n%s", table(run_rows(text, ended), 2).c_str());
  std::fflush(stdout);
}

}  // namespace barchan::app
