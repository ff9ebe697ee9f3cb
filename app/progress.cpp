#include <barchan/app/progress.hpp>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <barchan/app/json_text.hpp>
#include <barchan/app/readable.hpp>
#include <barchan/app/terminal.hpp>

namespace barchan::app {
namespace {

constexpr double kTerminalInterval = 0.25;  // [s]
constexpr double kPipeInterval = 10.0;      // [s]
constexpr double kFileInterval = 2.0;       // [s]

}  // namespace

Progress::Progress(const Simulation& simulation, bool is_quiet, std::string file)
    : simulation_(simulation),
      file_(std::move(file)),
      is_silent_(is_quiet),
      is_terminal_(::isatty(STDERR_FILENO) != 0),
      interval_(is_terminal_ ? kTerminalInterval : kPipeInterval),
      last_step_(simulation.step()) {}

Progress::~Progress() {
  if (last_write_ > 0.0) std::remove(file_.c_str());
}

std::int64_t Progress::most_steps() {
  const std::int64_t rest = simulation_.model().time.num_steps - simulation_.step();
  if (is_silent_) return rest;
  std::array<std::int64_t, 1> steps{1};
  if (simulation_.communicator().is_root()) {
    const Timings t = simulation_.timings();
    if (t.loop_seconds > 0.0)
      steps[0] = static_cast<std::int64_t>(static_cast<double>(t.steps) / t.loop_seconds *
                                           std::min(interval_, kFileInterval));
    // Grows gently, since the first steps tell little.
    steps[0] = std::clamp<std::int64_t>(steps[0], 1, std::max<std::int64_t>(16, 2 * t.steps));
  }
  simulation_.communicator().bcast(std::as_writable_bytes(std::span(steps)));
  return std::min(steps[0], rest);
}

void Progress::update() {
  if (!simulation_.communicator().is_root()) return;
  const double now = seconds_since(begin_);
  if (now - last_write_ >= kFileInterval) write(now);
  if (!is_silent_ && now - last_seconds_ >= 0.9 * interval_) print(now);
}

double Progress::seconds_left(double now) const {
  const std::int64_t rest = simulation_.model().time.num_steps - simulation_.step();
  return static_cast<double>(rest) * now /
         static_cast<double>(std::max<std::int64_t>(1, simulation_.timings().steps));
}

/// Not by way of the disk: a run must not wait for it, and nobody needs the file later.
void Progress::write(double now) {
  last_write_ = now;
  const Timings t = simulation_.timings();
  const Json json{{"step", simulation_.step()},
                  {"steps", simulation_.model().time.num_steps},
                  {"time", simulation_.time()},
                  {"particles", simulation_.num_particles()},
                  {"ranks", simulation_.communicator().size()},
                  {"seconds", now},
                  {"seconds_left", seconds_left(now)},
                  {"loop_steps", t.steps},
                  {"loop_seconds", t.loop_seconds},
                  {"in_flight_seconds", t.in_flight_seconds},
                  {"exposed_seconds", t.exposed_seconds}};
  const std::string temporary = file_ + ".tmp", text = compact_text(json) + "\n";
  std::FILE* file = std::fopen(temporary.c_str(), "w");
  if (file == nullptr) return;
  const bool is_whole = std::fwrite(text.data(), 1, text.size(), file) == text.size();
  const bool is_closed = std::fclose(file) == 0;
  if (!is_whole || !is_closed || std::rename(temporary.c_str(), file_.c_str()) != 0)
    std::remove(temporary.c_str());
}

void Progress::print(double now) {
  const Timings t = simulation_.timings();
  const std::int64_t step = simulation_.step(), end = simulation_.model().time.num_steps;
  const double loop = t.loop_seconds - last_loop_;
  const double rate = loop > 0.0 ? static_cast<double>(step - last_step_) / loop : 0.0;
  std::vector<std::string> parts{
      fmt::format("step {} of {} ({})", grouped(step), grouped(end),
                  percent(static_cast<double>(step) / static_cast<double>(end))),
      readable_time(seconds_left(now)) + " left",
      readable_rate(rate * static_cast<double>(simulation_.num_particles())) + " particle-steps/s"};
  if (t.in_flight_seconds > 0.0) {
    const double hidden = std::clamp(1.0 - t.exposed_seconds / t.in_flight_seconds, 0.0, 1.0);
    parts.push_back(percent(hidden) + " of communication hidden");
  }
  const std::string line = joined_within(parts, columns_of(STDERR_FILENO) - 1);
  std::fprintf(stderr, is_terminal_ ? "\r\033[K%s" : "%s\n", line.c_str());
  std::fflush(stderr);
  has_line_ = is_terminal_;
  last_seconds_ = now;
  last_loop_ = t.loop_seconds;
  last_step_ = step;
}

void Progress::clear() {
  if (!has_line_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  has_line_ = false;
}

}  // namespace barchan::app
