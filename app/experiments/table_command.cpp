#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include <barchan/app/commands.hpp>
#include <barchan/app/experiments/run_table.hpp>
#include <barchan/app/readable.hpp>

namespace barchan::app {
namespace {

constexpr double kBusy = 0.2;  // cores that others may use before times are rough

void print_notes(const RunTable& table, const char* begin) {
  const auto loudest =
      std::max_element(table.rows.begin(), table.rows.end(),
                       [](const PointRow& a, const PointRow& b) { return a.others < b.others; });
  if (loudest->others > kBusy)
    std::printf("%sOther processes used up to %.2f cores meanwhile: times are rough.\n", begin,
                loudest->others);
  if (table.digests.empty()) std::printf("%sDigests: equal wherever the deck is.\n", begin);
  for (const std::string& line : table.digests) std::printf("%s%s\n", begin, line.c_str());
}

std::string heading(const RunTable& table, const Experiment& experiment) {
  const Json& run = experiment.runs.front().run;
  return fmt::format("{}: {}, {} particles{}{}", experiment.path, run.value("deck", "?"),
                     grouped(run.value("particles", std::int64_t{0})),
                     table.common.empty() ? "" : "; ", text_of(table.common));
}

std::string base_text(const RunTable& table) {
  const Point shown = shown_base(table);
  if (shown.empty()) return "Medians.";
  return "Medians. Ratio: of the step to that of " + text_of(shown) + ".";
}

void print_text(const RunTable& table, const Experiment& experiment) {
  std::printf("%s\n%s", heading(table, experiment).c_str(),
              app::table(cells_of(table), std::max<std::size_t>(1, table.axes.size())).c_str());
  std::printf("  %s\n", base_text(table).c_str());
  print_notes(table, "  ");
}

void print_markdown(const RunTable& table, const Experiment& experiment) {
  std::printf("%s\n\n", heading(table, experiment).c_str());
  const auto cells = cells_of(table);
  const std::size_t num_left = std::max<std::size_t>(1, table.axes.size());
  for (std::size_t r = 0; r < cells.size(); ++r) {
    std::string line = "|", rule = "|";
    for (std::size_t c = 0; c < cells[r].size(); ++c) {
      line += " " + cells[r][c] + " |";
      rule += c < num_left ? " --- |" : " ---: |";
    }
    std::printf("%s\n", line.c_str());
    if (r == 0) std::printf("%s\n", rule.c_str());
  }
  std::printf("\n%s\n\n", base_text(table).c_str());
  print_notes(table, "");
}

/// A field of a CSV file, in quotes where it needs them.
std::string field(const Json& value) {
  std::string text = value.is_string() ? value.get<std::string>() : compact_text(value);
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

/// Runs of a folder may have other axes than the first one: columns are those of all.
void print_csv(const Experiment& experiment) {
  std::vector<Json> rows;
  std::vector<std::string> names;
  for (const Measurement& m : experiment.runs) {
    rows.push_back(json_of(m));
    for (const auto& [name, value] : rows.back().items()) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  for (std::size_t c = 0; c < names.size(); ++c)
    std::printf("%s%s", c > 0 ? "," : "", field(names[c]).c_str());
  std::printf("\n");
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < names.size(); ++c)
      std::printf("%s%s", c > 0 ? "," : "",
                  row.contains(names[c]) ? field(row[names[c]]).c_str() : "");
    std::printf("\n");
  }
}

}  // namespace

void print_runs(const TableArguments& arguments) {
  const Experiment experiment = read_experiment(arguments.path);
  const RunTable table = tabulate(experiment, arguments.against);
  if (arguments.format == TableFormat::Csv) print_csv(experiment);
  if (arguments.format == TableFormat::Json) std::puts(indented_text(json_of(table)).c_str());
  if (arguments.format == TableFormat::Markdown) print_markdown(table, experiment);
  if (arguments.format == TableFormat::Text) print_text(table, experiment);
  std::fflush(stdout);
}

}  // namespace barchan::app
