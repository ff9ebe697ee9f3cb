#include <algorithm>
#include <cstdio>
#include <filesystem>

#include <fmt/format.h>

#include <barchan/app/commands.hpp>
#include <barchan/app/experiments/programs.hpp>
#include <barchan/app/experiments/run_table.hpp>
#include <barchan/app/loaded_deck.hpp>
#include <barchan/app/readable.hpp>
#include <barchan/app/report/page.hpp>
#include <barchan/app/report/particles_view.hpp>
#include <barchan/app/report/series_data.hpp>
#include <barchan/app/report/trace_window.hpp>
#include <barchan/app/run_view.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/core/io/text_file.hpp>

namespace fs = std::filesystem;

namespace barchan::app {
namespace {

std::string name_of(const std::string& path) {
  const fs::path whole = fs::absolute(path).lexically_normal();
  return whole.has_filename() ? whole.filename().string() : whole.parent_path().filename().string();
}

/// Of a run that has ended: its numbers, machine and deck.
void add_run(const std::string& path, PageData& data) {
  PageData run = read_json(path);
  data["facts"] = PageData::array();
  for (const auto& row : run_rows(read_text_file(path), path)) data["facts"].push_back(row);
  data["machine"] = run.value("machine", PageData::object());
  data["deck"] = run.value("deck_keys", PageData::object());
  run.erase("deck_keys");
  data["about"] = fmt::format("{}{}", run.value("title", ""),
                              run.value("interrupted", false) ? " (interrupted)" : "");
  data["run"] = std::move(run);
}

PageData run_data(const std::string& folder, const ReportArguments& arguments) {
  PageData data{{"title", name_of(folder)}, {"about", "a run that has not ended"}};
  const std::string json = folder + "/run.json", series = folder + "/series.csv",
                    trace = folder + "/trace.json";
  if (fs::exists(json)) add_run(json, data);
  data["view"] =
      snapshots_view(folder, data.value("deck", PageData()), {.most_frames = arguments.frames});
  if (fs::exists(series)) data["series"] = series_data(series);
  if (arguments.steps && !fs::exists(trace))
    throw InputError(SourcePlace{trace, 0, 0}, "there is no trace", "run with --trace");
  if (fs::exists(trace)) data["trace"] = trace_window(trace, arguments.steps);
  return data;
}

/// The page of every run of a sweep, beside its results, and where it is from the sweep's own page.
PageData sweep_data(const Experiment& experiment, const ReportArguments& arguments,
                    const std::string& page) {
  const RunTable table = tabulate(experiment, "");
  PageData sweep = json_of(table);
  sweep["axes"] = table.axes;
  const Point base = shown_base(table);
  sweep["base"] = base.empty() ? "the only point" : text_of(base);
  const fs::path home = fs::absolute(page).parent_path();
  for (PageData& point : sweep["points"]) {
    for (PageData& run : point["runs"]) {
      const std::string folder = run["folder"], own = folder + "/report.html";
      write_page(own, run_data(folder, arguments));
      run["link"] = fs::relative(fs::absolute(own), home).string();
    }
  }
  const PageData& first = experiment.runs.front().run;
  PageData data{
      {"title", name_of(experiment.path)},
      {"about",
       fmt::format("a sweep of {}, {} particles; {}", first.value("deck", "a deck"),
                   grouped(first.value("particles", std::int64_t{0})), text_of(table.common))}};
  data["sweep"] = std::move(sweep);
  data["machine"] = first.value("machine", PageData::object());
  data["deck"] = first.value("deck_keys", PageData::object());
  return data;
}

/// What a deck makes: its particles, and what `barchan check` says.
PageData deck_data(const ReportArguments& arguments) {
  const LoadedDeck loaded = load_deck(arguments.path, arguments.settings);
  PageData data{{"title", name_of(arguments.path)}, {"about", loaded.deck.model.title}};
  data["view"] = deck_view(loaded);
  std::vector<std::string> words{own_path(), "check", arguments.path};
  for (const std::string& setting : arguments.settings)
    words.insert(words.end(), {"--set", setting});
  std::string said;
  (void)run_for_output(words, said);
  data["check"] = said;
  data["deck"] = PageData::object();
  for (const auto& [key, value] : loaded.deck.keys) data["deck"][key] = value;
  return data;
}

std::string page_path(const ReportArguments& arguments, bool is_folder) {
  if (!arguments.out.empty()) return arguments.out;
  if (is_folder) return arguments.path + "/report.html";
  return fs::path(arguments.path).stem().string() + ".html";
}

bool is_run(const std::string& folder) {
  return !fs::exists(folder + "/sweep.json") &&
         (fs::exists(folder + "/run.json") || fs::exists(folder + "/series.csv"));
}

}  // namespace

void report(const ReportArguments& arguments) {
  ReportArguments given = arguments;
  const fs::path path(given.path);
  if (path.filename() == "run.json")
    given.path = path.has_parent_path() ? path.parent_path().string() : ".";
  while (given.path.size() > 1 && given.path.back() == '/') given.path.pop_back();
  const bool is_folder = fs::is_directory(given.path);
  const std::string page = page_path(given, is_folder);
  if (!is_folder && !given.path.ends_with(".toml"))
    throw InputError(SourcePlace{given.path, 0, 0},
                     fs::exists(given.path) ? "is no folder and no deck" : "there is no such file",
                     "give the folder of a run or sweep, or a deck (.toml)");
  if (!given.settings.empty() && is_folder)
    throw InputError("--set changes a deck, and a folder is given",
                     "give the deck, or leave --set out");
  if (!is_folder)
    write_page(page, deck_data(given));
  else if (is_run(given.path))
    write_page(page, run_data(given.path, given));
  else
    write_page(page, sweep_data(read_experiment(given.path), given, page));
  std::printf("%s: %s\n", page.c_str(),
              readable_bytes(static_cast<double>(fs::file_size(page))).c_str());
  std::fflush(stdout);
}

}  // namespace barchan::app
