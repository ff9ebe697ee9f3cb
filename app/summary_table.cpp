#include <barchan/app/summary_table.hpp>

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include <fmt/format.h>

#include <barchan/app/readable.hpp>
#include <barchan/app/terminal.hpp>

namespace barchan::app {
namespace {

constexpr double kLeastShare = 0.0005;  // of a phase worth a word; run.json has all

using Rows = std::vector<std::vector<std::string>>;

std::string phases_of(const RunSummary& s) {
  std::vector<std::pair<double, std::string>> phases;
  double sum = 0.0;
  for (const auto& [name, seconds] : s.phases) {
    sum += seconds;
    phases.emplace_back(seconds, name);
  }
  std::sort(phases.rbegin(), phases.rend());
  std::string text;
  for (const auto& [seconds, name] : phases) {
    if (seconds > kLeastShare * sum)
      text += (text.empty() ? "" : ", ") + name + " " + percent(seconds / sum);
  }
  return text;
}

std::string energy_of(const RunSummary& s) {
  return fmt::format("kinetic {:.4g} J, elastic {:.4g} J, gravitational {:.4g} J",
                     s.measures.kinetic.value(), s.measures.elastic.value(),
                     s.measures.gravitational.value());
}

/// What was lost by what; none where nothing was.
std::string losses_of(const EnergyBudget& b) {
  std::string text;
  for (const auto& [loss, taker] :
       {std::pair(b.dashpot_loss, "dashpots"), std::pair(b.sliding_loss, "sliding"),
        std::pair(b.rolling_loss, "rolling"), std::pair(b.bond_loss, "bonds"),
        std::pair(b.damping_loss, "local damping")}) {
    if (loss != 0.0) text += fmt::format("{}{} {:.4g} J", text.empty() ? "" : ", ", taker, loss);
  }
  return text;
}

void add_communication(const RunSummary& s, Rows& rows) {
  if (s.ranks == 1) return;
  if (s.choice.is_measured) rows.push_back({"", s.choice.reason});
  if (!s.choice.hint.empty()) rows.push_back({"", "one-sided: " + s.choice.hint});
  rows.push_back(
      {"communication",
       fmt::format("{} in flight, {} exposed: {} hidden", readable_seconds(s.in_flight_seconds),
                   readable_seconds(s.exposed_seconds), percent(s.hidden_fraction()))});
  if (s.cuts.depth > 0) {
    rows.push_back(
        {"", fmt::format("shadows {} slab{} deep: {} of redundant work", s.cuts.depth,
                         s.cuts.depth == 1 ? "" : "s", readable_seconds(s.phases.at("shadows")))});
  }
  rows.push_back({"", fmt::format("{} messages, {}", grouped(static_cast<std::int64_t>(s.messages)),
                                  readable_bytes(static_cast<double>(s.bytes)))});
}

void add_state(const RunSummary& s, Rows& rows) {
  const auto broken = s.measures.broken_bonds;
  std::string state = fmt::format("{} contacts, largest overlap {:.3g} m",
                                  grouped(s.measures.contacts), s.measures.max_overlap);
  if (s.measures.bonds + broken > 0)
    state += fmt::format(", {} bonds, {} broken", grouped(s.measures.bonds), grouped(broken));
  rows.push_back({"state", state});
  for (std::size_t w = 0; w < s.walls.size(); ++w) {
    const Vec3& f = s.walls[w].force;
    const std::string z = s.dimension == 3 ? fmt::format(", {:.4g}", f.z()) : "";
    const std::string absent = s.walls[w].is_active ? "" : "  (not there yet)";
    rows.push_back({"", fmt::format("force on wall {}: ({:.4g}, {:.4g}{}) N{}",
                                    s.wall_specs[w].name, f.x(), f.y(), z, absent)});
  }
  rows.push_back({"energy", energy_of(s)});
  const std::string losses = s.budget ? losses_of(*s.budget) : "";
  if (!losses.empty()) rows.push_back({"", "lost to " + losses});
  rows.push_back({"digest", fmt::format("{:016x}", s.digest)});
}

}  // namespace

void print_summary(const RunSummary& s, const RunFolder& folder, const Model& model) {
  Rows rows;
  const char* kind = s.dimension == 2 ? "disks" : "spheres";
  rows.push_back({"particles", fmt::format("{} {}", grouped(s.particles), kind)});
  rows.push_back({"ranks", fmt::format("{} × {} thread{}, {} vectors", s.ranks, s.threads,
                                       s.threads == 1 ? "" : "s", s.vector)});
  if (s.ranks > 1)
    rows.push_back({"exchange", fmt::format("{} ({}), {}", s.exchange, s.transport, s.schedule)});
  rows.push_back(
      {"steps", fmt::format("{} of {:.4g} s: {:.6g} s simulated", grouped(s.steps), s.dt, s.time)});
  rows.push_back({"loop", fmt::format("{}, {} particle-steps/s", readable_seconds(s.loop_seconds),
                                      readable_rate(s.particle_steps_per_second()))});
  rows.push_back({"phases", phases_of(s)});
  add_communication(s, rows);
  rows.push_back({"lists", fmt::format("{} rebuilds, {} migrations, {}", grouped(s.rebuilds),
                                       grouped(s.migrations), readable_bytes(s.memory_bytes))});
  add_state(s, rows);
  rows.push_back({"results", folder.file("run.json")});
  rows.push_back({"", folder.file("series.csv")});
  rows.push_back({"", folder.file("snapshots/run.pvd")});
  if (model.output.picture) rows.push_back({"", folder.file("picture.png")});
  if (s.interrupted) {
    std::printf("Interrupted at step %s of %s; the results are those of that step.\n",
                grouped(s.steps).c_str(), grouped(model.time.num_steps).c_str());
  }
  std::fputs(table(wrapped_within(rows, columns_of(STDOUT_FILENO)), 2).c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace barchan::app
