#include <cstdio>

#include <fmt/format.h>

#include <barchan/app/commands.hpp>
#include <barchan/app/json_text.hpp>
#include <barchan/app/readable.hpp>

namespace barchan::app {
namespace {

using Rows = std::vector<std::vector<std::string>>;

std::string microseconds(double seconds) {
  const double us = 1e6 * seconds;
  if (us < 10.0) return fmt::format("{:.2f}", us);
  return us < 1000.0 ? fmt::format("{:.1f}", us) : grouped(static_cast<std::int64_t>(us + 0.5));
}

std::string size_of(std::size_t bytes) {
  if (bytes % (1 << 20) == 0) return fmt::format("{} MiB", bytes >> 20);
  if (bytes % (1 << 10) == 0) return fmt::format("{} KiB", bytes >> 10);
  return fmt::format("{} B", bytes);
}

std::string links_of(const ProbeReport& r) {
  if (r.num_on_node == r.num_links) return "all within a node";
  if (r.num_on_node == 0) return "all between nodes";
  return fmt::format("{} within a node, {} between nodes", r.num_on_node,
                     r.num_links - r.num_on_node);
}

void print_head(const ProbeReport& r, int ranks) {
  Rows head{{"MPI", r.mpi_library + ", thread level " + r.thread_level},
            {"window", r.window.empty() ? "MPI cannot make one here" : r.window},
            {"links", fmt::format("{} between {} ranks, {}", r.num_links, ranks, links_of(r))}};
  std::fputs(table(head, 2).c_str(), stdout);
}

void print_rows(const ProbeReport& r) {
  Rows rows{{"exchange", "message", "half trip [µs]", "p99", "most", "both ways [µs]", "CPU [µs]",
             "overlap", "availability"}};
  for (const ProbeRow& row : r.plain_put) {
    rows.push_back({row.exchange, size_of(row.bytes), microseconds(row.cost.half_round_trip), "-",
                    "-", "-", "-", "-", "-"});
  }
  for (const ProbeRow& row : r.rows) {
    const ExchangeCost& c = row.cost;
    rows.push_back({row.exchange, size_of(row.bytes), microseconds(c.half_round_trip),
                    microseconds(c.half_p99), microseconds(c.half_most), microseconds(c.both_ways),
                    microseconds(c.cpu), percent(c.overlap), percent(c.availability)});
  }
  std::fputs("\n", stdout);
  std::fputs(table(rows).c_str(), stdout);
}

void print_obstacles(const ProbeReport& r) {
  if (!r.obstacles.empty()) std::fputs("\n", stdout);
  for (const std::string& line : lines_of(r.obstacles)) {
    std::fprintf(stdout, "  not here: %s\n", line.c_str());
  }
}

/// @param is_answer  whether what does not work is a part of the answer, and not of a refusal
void print_table(const ProbeReport& r, int ranks, bool is_answer) {
  print_head(r, ranks);
  if (!r.rows.empty()) print_rows(r);
  if (is_answer) print_obstacles(r);
  std::fflush(stdout);
}

Json row_of(const ProbeRow& row) {
  return {{"exchange", row.exchange},
          {"bytes", row.bytes},
          {"half_round_trip_seconds", row.cost.half_round_trip},
          {"half_round_trip_p99_seconds", row.cost.half_p99},
          {"half_round_trip_most_seconds", row.cost.half_most},
          {"both_ways_seconds", row.cost.both_ways},
          {"cpu_seconds", row.cost.cpu},
          {"overlap", row.cost.overlap},
          {"availability", row.cost.availability}};
}

void print_json(const ProbeReport& r, int ranks) {
  Json json{{"mpi", r.mpi_library}, {"thread_level", r.thread_level},
            {"window", r.window},   {"ranks", ranks},
            {"links", r.num_links}, {"links_on_node", r.num_on_node}};
  json["plain_put"] = json["exchanges"] = json["obstacles"] = Json::array();
  for (const ProbeRow& row : r.plain_put) {
    json["plain_put"].push_back(
        {{"bytes", row.bytes}, {"half_round_trip_seconds", row.cost.half_round_trip}});
  }
  for (const ProbeRow& row : r.rows) json["exchanges"].push_back(row_of(row));
  for (const ExchangeObstacle& o : r.obstacles) {
    json["obstacles"].push_back({{"exchange", o.exchange}, {"reason", o.reason}});
  }
  std::puts(indented_text(json).c_str());
  std::fflush(stdout);
}

void print_csv(const ProbeReport& r) {
  std::puts(
      "exchange,bytes,half_round_trip_us,half_round_trip_p99_us,half_round_trip_most_us,both_ways_"
      "us,"
      "cpu_us,overlap,availability");
  for (const ProbeRow& row : r.plain_put) {
    std::puts(fmt::format("plain put,{},{:.4f},,,,,,", row.bytes, 1e6 * row.cost.half_round_trip)
                  .c_str());
  }
  for (const ProbeRow& row : r.rows) {
    const ExchangeCost& c = row.cost;
    std::puts(fmt::format("{},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f}", row.exchange,
                          row.bytes, 1e6 * c.half_round_trip, 1e6 * c.half_p99, 1e6 * c.half_most,
                          1e6 * c.both_ways, 1e6 * c.cpu, c.overlap, c.availability)
                  .c_str());
  }
  std::fflush(stdout);
}

/// What does not work among all is a line of the answer; what was asked for by name is a refusal.
bool is_refused(const ProbeReport& r, const ProbeOptions& options) {
  return !r.obstacles.empty() && (!options.exchanges.empty() || r.rows.empty());
}

[[noreturn]] void refuse(const ProbeReport& r) {
  std::string text = "some of these exchanges do not work between these ranks";
  for (const std::string& line : lines_of(r.obstacles)) text += "\n  not here: " + line;
  throw InputError(text, "");
}

}  // namespace

void probe(const Communicator& world, const ProbeArguments& arguments) {
  const ProbeReport report = probe_exchanges(world, arguments.options);
  const bool refused = is_refused(report, arguments.options);
  if (world.is_root()) {
    if (arguments.json)
      print_json(report, world.size());
    else if (arguments.csv)
      print_csv(report);
    else
      print_table(report, world.size(), !refused);
  }
  if (refused) refuse(report);
}

}  // namespace barchan::app
