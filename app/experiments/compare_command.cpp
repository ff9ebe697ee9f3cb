#include <cstdio>

#include <fmt/format.h>

#include <barchan/app/commands.hpp>
#include <barchan/app/experiments/comparison.hpp>
#include <barchan/app/experiments/run_table.hpp>
#include <barchan/app/readable.hpp>

namespace barchan::app {
namespace {

using Rows = std::vector<std::vector<std::string>>;

std::string change(double a, double b) {
  return a > 0.0 ? fmt::format("{:+.1f} %", 100.0 * (b / a - 1.0)) : "";
}

std::string bounds(const Interval& ratio) {
  if (ratio.confidence == 0.0) return "";
  return fmt::format("{:+.1f} … {:+.1f} % ({:.0f} % sure)", 100.0 * (ratio.low - 1.0),
                     100.0 * (ratio.high - 1.0), 100.0 * ratio.confidence);
}

/// Axes along which pairs differ, for the first columns.
std::vector<std::string> axes_of(const std::vector<PointPair>& pairs) {
  std::vector<Point> points;
  for (const PointPair& pair : pairs) points.push_back(pair.point);
  return varied_axes(points);
}

void print_pairs(const std::vector<PointPair>& pairs) {
  const std::vector<std::string> axes = axes_of(pairs);
  Rows rows{axes};
  for (const char* name : {"runs", "A: step [µs]", "B: step [µs]", "B to A", "between", "verdict"})
    rows.front().emplace_back(name);
  for (const PointPair& pair : pairs) {
    std::vector<std::string> row;
    for (const std::string& axis : axes) row.push_back(value_of(pair.point, axis));
    row.push_back(fmt::format("{}, {}", pair.a.size(), pair.b.size()));
    const double a = median(steps_of(pair.a)), b = median(steps_of(pair.b));
    row.push_back(microseconds(a));
    row.push_back(microseconds(b));
    row.push_back(change(1.0, pair.ratio.value));
    row.push_back(bounds(pair.ratio));
    row.push_back(pair.verdict());
    rows.push_back(row);
  }
  std::fputs(table(rows, axes.size()).c_str(), stdout);
  if (pairs.front().ratio.confidence < 0.85)
    std::puts(
        "  Bounds need repetitions: six alternating ones (barchan sweep --repeat 6) give 97 %.");
}

void print_parts(const PointPair& pair) {
  Rows rows{{"[µs a step]", "A", "B", "B to A"}};
  for (const PartTimes& part : parts_of(pair))
    rows.push_back({part.part, microseconds(part.a), microseconds(part.b), change(part.a, part.b)});
  const auto hidden = [](const std::vector<const Measurement*>& runs) {
    return median(figures_of(runs, [](const Measurement& m) { return m.hidden(); }));
  };
  rows.push_back({"hidden", percent(hidden(pair.a)), percent(hidden(pair.b)), ""});
  std::printf("Parts of a step, medians of the means over ranks:\n%s", table(rows).c_str());
}

void print_differences(const std::vector<Difference>& found) {
  if (found.empty()) {
    std::puts("Nothing differs in deck, machine, library or settings; digests are equal.");
    return;
  }
  Rows rows{{"", "A", "B"}};
  for (const Difference& d : found) rows.push_back({d.what, d.a, d.b});
  std::printf("What differs:\n%s", table(rows, 3).c_str());
}

Json json_of(const PointPair& pair) {
  Json point = Json::object(), parts = Json::object(), differ = Json::object();
  for (const auto& [axis, value] : pair.point) point[axis] = value;
  for (const PartTimes& part : parts_of(pair)) parts[part.part] = {part.a, part.b};
  for (const Difference& d : differences(pair.a.front()->run, pair.b.front()->run))
    differ[d.what] = {d.a, d.b};
  return {{"point", point},
          {"runs", {pair.a.size(), pair.b.size()}},
          {"paired", pair.are_paired},
          {"step_us", {median(steps_of(pair.a)), median(steps_of(pair.b))}},
          {"ratio", pair.ratio.value},
          {"low", pair.ratio.low},
          {"high", pair.ratio.high},
          {"confidence", pair.ratio.confidence},
          {"verdict", pair.verdict()},
          {"parts_us", parts},
          {"differences", differ}};
}

}  // namespace

void compare(const CompareArguments& arguments) {
  const Selection a = read_selection(arguments.a), b = read_selection(arguments.b);
  const std::vector<PointPair> pairs = match(a, b, arguments.confidence);
  if (arguments.json) {
    Json json = Json::array();
    for (const PointPair& pair : pairs) json.push_back(json_of(pair));
    std::puts(indented_text(json).c_str());
  } else {
    std::printf("A: %s\nB: %s%s\n", arguments.a.c_str(), arguments.b.c_str(),
                pairs.front().are_paired ? ", measured in turn" : "");
    print_pairs(pairs);
    if (pairs.size() == 1) print_parts(pairs.front());
    print_differences(differences(pairs.front().a.front()->run, pairs.front().b.front()->run));
  }
  std::fflush(stdout);
}

}  // namespace barchan::app
