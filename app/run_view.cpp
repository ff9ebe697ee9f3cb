#include <barchan/app/run_view.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include <barchan/app/json_text.hpp>
#include <barchan/app/readable.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/core/io/text_file.hpp>

namespace barchan::app {
namespace {

/// A plain value as text; some other program may have written the file.
std::string word(const Json& json, const char* key) {
  const auto it = json.find(key);
  if (it == json.end() || it->is_structured()) return "?";
  return it->is_string() ? it->get<std::string>() : compact_text(*it);
}

std::int64_t whole(const Json& json, const char* key) {
  const double value = number_in(json, key);
  return std::isnan(value) ? 0 : static_cast<std::int64_t>(std::clamp(value, -9e18, 9e18));
}

Json parse_run(std::string_view text, const std::string& path) {
  Json json = parsed(text);
  if (json.is_object() && json.contains("state_digest")) return json;
  throw InputError(SourcePlace{path, 0, 0}, "is no run.json of barchan",
                   "give a run's folder or its run.json");
}

}  // namespace

Rows run_rows(std::string_view text, const std::string& path) {
  const Json run = parse_run(text, path);
  const Json communication = object_in(run, "communication");
  const Json energy = object_in(run, "energy");
  Rows rows{{"deck", word(run, "deck")},
            {"particles", grouped(whole(run, "particles"))},
            {"ranks", fmt::format("{} × {} thread{}", word(run, "ranks"), word(run, "threads"),
                                  whole(run, "threads") == 1 ? "" : "s")},
            {"exchange",
             word(run, "exchange") + " (" + word(run, "transport") + "), " + word(run, "schedule")},
            {"steps", fmt::format("{} of {:g} s: {:.6g} s simulated", grouped(whole(run, "steps")),
                                  number_in(run, "dt"), number_in(run, "time"))},
            {"loop", fmt::format("{}, {} particle-steps/s",
                                 readable_seconds(number_in(run, "loop_seconds")),
                                 readable_rate(number_in(run, "particle_steps_per_second")))},
            {"hidden", percent(number_in(communication, "hidden_fraction")) + " of communication"},
            {"contacts", grouped(whole(run, "contacts"))},
            {"energy", fmt::format("kinetic {:.4g} J, potential {:.4g} J",
                                   number_in(energy, "kinetic"), number_in(energy, "potential"))},
            {"digest", word(run, "state_digest")},
            {"version", word(run, "version")}};
  if (word(run, "interrupted") == "true")
    rows.push_back({"note", "interrupted before its last step"});
  return rows;
}

bool is_series(std::string_view text) {
  return text.starts_with("step,time,");
}

Rows series_rows(std::string_view text, const std::string& path) {
  LineReader lines(text, path);
  std::string_view line, last;
  std::int64_t rows = -1;
  while (lines.next(line)) {
    ++rows;
    last = line;
  }
  Rows shown{{"rows", grouped(rows)}};
  if (rows > 0) shown.push_back({"last", fmt::format("step {}", last.substr(0, last.find(',')))});
  return shown;
}

}  // namespace barchan::app
