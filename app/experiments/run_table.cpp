#include <barchan/app/experiments/run_table.hpp>

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include <barchan/app/experiments/statistics.hpp>
#include <barchan/app/readable.hpp>
#include <barchan/core/base/error.hpp>

namespace barchan::app {
namespace {

PointRow row_of(const Experiment& experiment, const Point& point) {
  PointRow row;
  row.point = point;
  row.runs = experiment.of(point);
  const auto middle = [&](auto&& figure) { return median(figures_of(row.runs, figure)); };
  row.step = middle([](const Measurement& m) { return m.step(); });
  row.spread = spread(steps_of(row.runs));
  row.in_flight = middle([](const Measurement& m) { return m.communication("in_flight_seconds"); });
  row.exposed = middle([](const Measurement& m) { return m.communication("exposed_seconds"); });
  row.work = middle([](const Measurement& m) { return m.work(); });
  row.hidden = middle([](const Measurement& m) { return m.hidden(); });
  for (const Measurement* m : row.runs) row.others = std::max(row.others, m->others);
  return row;
}

/// Of a row's steps to those of a base, repetition by repetition.
double ratio_of(const PointRow& row, const std::vector<const Measurement*>& base) {
  std::vector<double> ratios;
  for (const Measurement* m : row.runs) {
    const auto same = std::find_if(base.begin(), base.end(), [&](const Measurement* other) {
      return other->repetition == m->repetition;
    });
    if (same != base.end()) ratios.push_back(m->step() / (*same)->step());
  }
  return median(ratios);
}

/// What changes a run's bits: all but how it is carried out.
Point physics_of(const Point& point) {
  Point keys;
  for (const AxisValue& at : point) {
    if (at.axis.find('.') != std::string::npos || at.axis == "gravity") keys.push_back(at);
  }
  return keys;
}

std::vector<std::string> digests_of(const Experiment& experiment) {
  std::map<std::string, std::map<std::string, std::set<std::string>>> points;  // physics, digest
  for (const Measurement& m : experiment.runs) {
    const std::string deck =
        m.run.value("deck", "") + ", " + std::to_string(m.run.value("steps", std::int64_t{0})) +
        " steps" + (physics_of(m.point).empty() ? "" : ", " + text_of(physics_of(m.point)));
    points[deck][m.digest()].insert(text_of(m.point));
  }
  std::vector<std::string> lines;
  for (const auto& [deck, of_digest] : points) {
    if (of_digest.size() == 1) continue;
    for (const auto& [digest, names] : of_digest)
      lines.push_back(fmt::format("{} ended with {} at {} points, such as {}", deck, digest,
                                  names.size(), *names.begin()));
  }
  return lines;
}

}  // namespace

RunTable tabulate(const Experiment& experiment, const std::string& against) {
  RunTable table;
  const std::vector<Point> points = experiment.points();
  table.axes = varied_axes(points);
  for (const AxisValue& at : points.front()) {
    if (std::find(table.axes.begin(), table.axes.end(), at.axis) == table.axes.end())
      table.common.push_back(at);
  }
  table.base = against.empty() ? points.front() : parse_point(against);
  bool is_there = false;
  for (const Point& point : points) {
    table.rows.push_back(row_of(experiment, point));
    PointRow& row = table.rows.back();
    const auto base = experiment.of(against.empty() ? table.base : with(point, table.base));
    row.ratio =
        has(base.empty() ? Point{} : base.front()->point, table.base) ? ratio_of(row, base) : 0.0;
    is_there |= row.ratio > 0.0;
  }
  if (!is_there)
    throw InputError(fmt::format("--against: no point has {}", against),
                     "give values of its axes, such as " + text_of({points.front().front()}));
  table.digests = digests_of(experiment);
  return table;
}

Point shown_base(const RunTable& table) {
  return without(table.base, table.common);
}

std::string microseconds(double time) {
  return time < 1e4 ? fmt::format("{:#.4g}", time) : grouped(static_cast<std::int64_t>(time + 0.5));
}

std::vector<std::vector<std::string>> cells_of(const RunTable& table) {
  std::vector<std::vector<std::string>> cells{table.axes};
  if (table.axes.empty()) cells.front().emplace_back("point");
  for (const char* name : {"runs", "step [µs]", "spread", "ratio", "work [µs]", "in flight [µs]",
                           "exposed [µs]", "hidden", "others"})
    cells.front().emplace_back(name);
  for (const PointRow& row : table.rows) {
    std::vector<std::string> line;
    for (const std::string& axis : table.axes) line.push_back(value_of(row.point, axis));
    if (table.axes.empty()) line.emplace_back("the only one");
    const std::string ratio = row.ratio > 0.0 ? fmt::format("{:.3f}", row.ratio) : "–";
    for (const std::string& text :
         {std::to_string(row.runs.size()), microseconds(row.step), percent(row.spread), ratio,
          microseconds(row.work), microseconds(row.in_flight), microseconds(row.exposed),
          percent(row.hidden), fmt::format("{:.2f}", row.others)})
      line.push_back(text);
    cells.push_back(line);
  }
  return cells;
}

Json json_of(const Measurement& m) {
  Json json = Json::object();
  for (const auto& [axis, value] : m.point) json[axis] = value;
  json["repetition"] = m.repetition;
  json["step_us"] = m.step();
  json["work_us"] = m.work();
  json["in_flight_us"] = m.communication("in_flight_seconds");
  json["exposed_us"] = m.communication("exposed_seconds");
  json["hidden"] = m.hidden();
  json["others"] = m.others;
  for (const char* key : {"particles", "steps", "loop_seconds", "rebuilds", "transport"})
    json[key] = m.run.value(key, Json());
  json["exchange_used"] = m.run.value("exchange", Json());
  json["digest"] = m.digest();
  json["folder"] = m.folder;
  return json;
}

Json json_of(const RunTable& table) {
  Json json{{"digests_equal", table.digests.empty()}};
  json["points"] = Json::array();
  for (const PointRow& row : table.rows) {
    Json point = Json::object(), runs = Json::array();
    for (const auto& [axis, value] : row.point) point[axis] = value;
    for (const Measurement* m : row.runs) runs.push_back(json_of(*m));
    json["points"].push_back({{"point", point},
                              {"step_us", row.step},
                              {"spread", row.spread},
                              {"ratio", row.ratio > 0.0 ? Json(row.ratio) : Json(nullptr)},
                              {"work_us", row.work},
                              {"in_flight_us", row.in_flight},
                              {"exposed_us", row.exposed},
                              {"hidden", row.hidden},
                              {"others", row.others},
                              {"runs", runs}});
  }
  return json;
}

}  // namespace barchan::app
