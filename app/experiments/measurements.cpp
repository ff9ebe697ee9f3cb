#include <barchan/app/experiments/measurements.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>

namespace fs = std::filesystem;

namespace barchan::app {
namespace {

std::string word(const Json& json, const char* key) {
  const auto it = json.find(key);
  if (it == json.end() || it->is_null()) return {};
  return it->is_string() ? it->get<std::string>() : compact_text(*it);
}

bool has_ended(const Json& run) {
  return run.contains("state_digest") && run.contains("loop_seconds") &&
         !run.value("interrupted", false);
}

Point point_of_run(const Json& run) {
  Point point;
  for (const char* axis : {"ranks", "threads", "exchange", "schedule", "progress"})
    point.push_back({axis, word(run, axis)});
  return point;
}

void add_run(const std::string& folder, Experiment& experiment) {
  Measurement m;
  m.run = read_json(folder + "/run.json");
  if (m.run.is_null() || !has_ended(m.run)) return;
  m.folder = folder;
  m.point = point_of_run(m.run);
  experiment.runs.push_back(std::move(m));
}

std::vector<std::string> entries_of(const std::string& folder) {
  std::vector<std::string> paths;
  for (const auto& entry : fs::directory_iterator(folder)) paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end());
  return paths;
}

/// Of a record DIR/runs/POINT/N.json, beside which the run lies in N/.
void add_record(const std::string& path, Experiment& experiment) {
  const Json record = read_json(path);
  const Json run = read_json(path.substr(0, path.size() - 5) + "/run.json");
  if (run.is_null() || !has_ended(run) || !record.contains("point")) return;
  Measurement m;
  for (const Json& at : record["point"]) m.point.push_back({word(at, "axis"), word(at, "value")});
  m.repetition = static_cast<int>(number_in(record, "repetition"));
  m.others = number_in(record, "others");
  m.folder = path.substr(0, path.size() - 5);
  m.run = run;
  experiment.runs.push_back(std::move(m));
}

/// Places of the values along the axes of a sweep, as they were asked for.
void sort_as_asked(Experiment& experiment) {
  std::map<std::string, std::size_t> places;
  std::vector<std::string> axes;
  for (const Json& axis : experiment.sweep.value("axes", Json::array())) {
    axes.push_back(word(axis, "axis"));
    for (const Json& value : axis.value("values", Json::array()))
      places.emplace(axes.back() + "=" + value.get<std::string>(), places.size());
  }
  const auto key = [&](const Measurement& m) {
    std::vector<std::size_t> at;
    for (const std::string& axis : axes) {
      const auto it = places.find(axis + "=" + value_of(m.point, axis));
      at.push_back(it == places.end() ? places.size() : it->second);
    }
    return std::make_tuple(at, text_of(m.point), m.repetition);
  };
  std::stable_sort(experiment.runs.begin(), experiment.runs.end(),
                   [&](const Measurement& a, const Measurement& b) { return key(a) < key(b); });
}

void number_repetitions(Experiment& experiment) {
  std::map<std::string, int> numbers;
  for (Measurement& m : experiment.runs) m.repetition = ++numbers[text_of(m.point)];
}

}  // namespace

double Measurement::per_step(double seconds) const {
  const double steps = number_in(run, run.contains("loop_steps") ? "loop_steps" : "steps");
  return 1e6 * seconds / std::max(1.0, steps);
}

double Measurement::step() const {
  return per_step(number_in(run, "loop_seconds"));
}

double Measurement::communication(const char* key) const {
  return per_step(number_in(object_in(run, "communication"), key));
}

double Measurement::work() const {
  const Json phases = object_in(run, "phases");
  return per_step(number_in(phases, "forces") + number_in(phases, "bands") +
                  number_in(phases, "search"));
}

double Measurement::hidden() const {
  return number_in(object_in(run, "communication"), "hidden_fraction");
}

std::string Measurement::digest() const {
  return word(run, "state_digest");
}

std::vector<Point> Experiment::points() const {
  std::vector<Point> points;
  for (const Measurement& m : runs) {
    if (std::find(points.begin(), points.end(), m.point) == points.end()) points.push_back(m.point);
  }
  return points;
}

std::vector<const Measurement*> Experiment::of(const Point& point) const {
  std::vector<const Measurement*> found;
  for (const Measurement& m : runs) {
    if (m.point == point) found.push_back(&m);
  }
  return found;
}

Experiment read_experiment(const std::string& path) {
  Experiment experiment;
  experiment.path = path;
  if (!fs::exists(path))
    throw InputError(SourcePlace{path, 0, 0}, "there is no such folder",
                     "give the folder of a sweep or run");
  const fs::path given(path);
  if (given.filename() == "run.json") {
    add_run(given.has_parent_path() ? given.parent_path().string() : ".", experiment);
  } else if (fs::is_directory(path)) {
    experiment.sweep = read_json(path + "/sweep.json");
    if (experiment.sweep.is_null()) {
      add_run(path, experiment);
      const bool is_run = !experiment.runs.empty();
      for (const std::string& entry : is_run ? std::vector<std::string>{} : entries_of(path))
        add_run(entry, experiment);
      number_repetitions(experiment);
    } else if (fs::is_directory(path + "/runs")) {
      for (const std::string& point : entries_of(path + "/runs")) {
        for (const std::string& entry : entries_of(point))
          if (entry.ends_with(".json")) add_record(entry, experiment);
      }
      sort_as_asked(experiment);
    }
  }
  if (experiment.runs.empty())
    throw InputError(SourcePlace{path, 0, 0}, "has no run that has ended",
                     "give the folder of a sweep, or of a run with its run.json");
  return experiment;
}

Selection read_selection(const std::string& text) {
  const auto colon = text.rfind(':');
  const bool is_selected =
      colon != std::string::npos && !fs::exists(text) && text.find('=', colon) != std::string::npos;
  if (!is_selected) return {read_experiment(text), {}};
  Selection selection{read_experiment(text.substr(0, colon)), parse_point(text.substr(colon + 1))};
  auto& runs = selection.experiment.runs;
  const std::vector<std::string> axes = varied_axes(selection.experiment.points());
  std::erase_if(runs, [&](const Measurement& m) { return !has(m.point, selection.values); });
  if (!runs.empty()) return selection;
  std::string names;
  for (const std::string& axis : axes) names += (names.empty() ? "" : ", ") + axis;
  throw InputError(SourcePlace{text.substr(0, colon), 0, 0},
                   fmt::format("has no run with {}", text.substr(colon + 1)),
                   names.empty() ? "it has one point only" : "its axes are " + names);
}

std::vector<double> steps_of(const std::vector<const Measurement*>& runs) {
  return figures_of(runs, [](const Measurement& m) { return m.step(); });
}

}  // namespace barchan::app
