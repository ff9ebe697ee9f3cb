#include <barchan/app/experiments/sweep_folder.hpp>

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include <barchan/app/json_text.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/core/io/text_file.hpp>
#include <barchan/tasks/results/run_summary.hpp>

namespace fs = std::filesystem;

namespace barchan::app {
namespace {

/// What every run of a sweep has in common.
Json identity(const SweepArguments& arguments) {
  return {{"deck", arguments.deck},
          {"deck_text", read_text_file(arguments.deck)},
          {"settings", arguments.settings},
          {"steps", arguments.steps ? Json(*arguments.steps) : Json(nullptr)},
          {"launcher", arguments.launcher}};
}

/// The axes of a plan, with values of an earlier part of the sweep where they had others.
Json axes_of(const SweepPlan& plan, const Json& earlier) {
  Json axes = earlier.is_array() ? earlier : Json::array();
  for (const Axis& axis : plan.axes()) {
    const auto same = std::find_if(axes.begin(), axes.end(), [&](const Json& old) {
      return old.value("axis", "") == axis.name;
    });
    if (same == axes.end()) {
      axes.push_back({{"axis", axis.name}, {"values", axis.values}});
      continue;
    }
    Json& values = (*same)["values"];
    for (const std::string& value : axis.values) {
      if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
    }
  }
  return axes;
}

}  // namespace

SweepFolder::SweepFolder(const SweepPlan& plan, const SweepArguments& arguments)
    : path_(plan.folder()), keeps_(arguments.keep) {
  check(arguments);
  std::error_code failed;
  fs::create_directories(path_ + "/runs", failed);
  if (failed)
    throw InputError(SourcePlace{path_, 0, 0}, "cannot be made: " + failed.message(),
                     "give another --out");
  const std::string file = path_ + "/sweep.json";
  Json json = identity(arguments);
  const Json before = read_json(file);
  json["axes"] = axes_of(plan, before.is_object() ? before.value("axes", Json()) : Json());
  json["version"] = version();
  write_json(file, json);
}

void SweepFolder::check(const SweepArguments& arguments) const {
  const std::string file = path_ + "/sweep.json";
  if (!fs::exists(path_)) return;
  if (!fs::is_directory(path_) || (!fs::exists(file) && !fs::is_empty(path_)))
    throw InputError(SourcePlace{path_, 0, 0}, "is not the folder of a sweep",
                     "give another --out");
  if (!fs::exists(file)) return;
  const Json was = read_json(file);
  const Json is = identity(arguments);
  for (const auto& [key, value] : is.items()) {
    if (key == "deck" || was.value(key, Json()) == value) continue;
    if (arguments.force) {
      fs::remove_all(path_ + "/runs");
      fs::remove(file);
      return;
    }
    throw InputError(SourcePlace{path_, 0, 0},
                     fmt::format("is of a sweep with {}",
                                 key == "deck_text" ? "another text of the deck" : "other " + key),
                     "give another --out, or --force to replace it");
  }
}

std::string SweepFolder::run(const Point& point, int repetition) const {
  const std::string folder = path_ + "/runs/" + folder_name(point);
  fs::create_directories(folder);
  return fmt::format("{}/{}", folder, repetition);
}

bool SweepFolder::is_done(const Point& point, int repetition) const {
  return fs::exists(fmt::format("{}/runs/{}/{}.json", path_, folder_name(point), repetition));
}

void SweepFolder::add(const Point& point, int repetition, const RunRecord& record) const {
  const std::string out = run(point, repetition);
  std::error_code ignored;
  if (!keeps_) fs::remove_all(out + "/snapshots", ignored);
  fs::remove(out + ".log", ignored);
  Json at = Json::array();
  for (const auto& [axis, value] : point) at.push_back({{"axis", axis}, {"value", value}});
  write_json(out + ".json", {{"point", at},
                             {"repetition", repetition},
                             {"seconds", record.seconds},
                             {"others", record.others},
                             {"command", record.words}});
}

std::string SweepFolder::last_words(const std::string& log) {
  const std::string text = read_text_file(log);
  LineReader lines(text, log);
  std::string_view line, last;
  while (lines.next(line)) {
    if (line.starts_with("barchan: ") || line.starts_with("netlab: "))
      return std::string(line.substr(line.find(' ') + 1));
    if (!trimmed(line).empty()) last = line;
  }
  return last.empty() ? "it said nothing" : std::string(last);
}

}  // namespace barchan::app
