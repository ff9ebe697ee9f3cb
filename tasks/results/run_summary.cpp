#include <barchan/tasks/results/run_summary.hpp>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <set>
#include <thread>

#include <nlohmann/json.hpp>

#include <barchan/comm/base/mpi_session.hpp>
#include <barchan/core/base/host_name.hpp>

namespace barchan {
namespace {

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return {};
}

/// What the other ranks must hear of one.
std::string own_numbers(const Simulation& simulation) {
  const Timings t = simulation.timings();
  nlohmann::json kinds;
  for (const auto& [name, time] : t.communication)
    kinds[name] = {time.in_flight, time.exposed, time.late};
  const nlohmann::json numbers{{"host", host_name()},
                               {"owned", simulation.num_owned()},
                               {"memory", simulation.memory_bytes()},
                               {"loop", t.loop_seconds},
                               {"phases", t.phases},
                               {"worked", t.worked},
                               {"in_flight", t.in_flight_seconds},
                               {"exposed", t.exposed_seconds},
                               {"kinds", kinds},
                               {"rebuilds", t.rebuilds},
                               {"migrations", t.migrations},
                               {"transport", t.exchange.transport},
                               {"messages", t.exchange.messages()},
                               {"bytes", t.exchange.bytes()}};
  return numbers.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void add_numbers(const std::vector<std::string>& of_ranks, RunSummary& summary) {
  const auto share = 1.0 / static_cast<double>(of_ranks.size());
  std::set<std::string> hosts;
  for (const std::string& text : of_ranks) {
    const auto n = nlohmann::json::parse(text);
    hosts.insert(n.at("host").get<std::string>());
    summary.owned.push_back(n.at("owned"));
    summary.memory_bytes += n.at("memory").get<double>();
    summary.loop_seconds = std::max(summary.loop_seconds, n.at("loop").get<double>());
    for (const auto& [name, seconds] : n.at("phases").items()) {
      summary.phases[name] += share * seconds.get<double>();
      summary.phases_most[name] = std::max(summary.phases_most[name], seconds.get<double>());
    }
    for (const double seconds : n.at("worked")) summary.lanes_worked.push_back(seconds);
    for (const auto& [name, time] : n.at("kinds").items()) {
      summary.communication[name].in_flight += share * time.at(0).get<double>();
      summary.communication[name].exposed += share * time.at(1).get<double>();
      summary.communication[name].late += share * time.at(2).get<double>();
    }
    summary.exposed_most = std::max(summary.exposed_most, n.at("exposed").get<double>());
    summary.in_flight_seconds += share * n.at("in_flight").get<double>();
    summary.exposed_seconds += share * n.at("exposed").get<double>();
    summary.rebuilds = std::max(summary.rebuilds, n.at("rebuilds").get<std::int64_t>());
    summary.migrations += n.at("migrations").get<std::int64_t>();
    summary.messages += n.at("messages").get<std::uint64_t>();
    summary.bytes += n.at("bytes").get<std::uint64_t>();
    if (summary.transport.empty()) summary.transport = n.at("transport");
  }
  if (summary.transport.empty()) summary.transport = "none";
  summary.machine.hosts = static_cast<int>(hosts.size());
}

}  // namespace

double RunSummary::particle_steps_per_second() const {
  return loop_seconds > 0.0
             ? static_cast<double>(particles) * static_cast<double>(loop_steps) / loop_seconds
             : 0.0;
}

double RunSummary::hidden_fraction() const {
  if (!(in_flight_seconds > 0.0)) return 1.0;
  return std::clamp(1.0 - exposed_seconds / in_flight_seconds, 0.0, 1.0);
}

double RunSummary::imbalance() const {
  double sum = 0.0, most = 0.0;
  for (const double seconds : lanes_worked) sum += seconds, most = std::max(most, seconds);
  return sum > 0.0 ? most * static_cast<double>(lanes_worked.size()) / sum : 1.0;
}

double RunSummary::potential() const {
  return measures.elastic.value() + measures.gravitational.value();
}

std::optional<double> RunSummary::grain_of_smallest_weight() const {
  if (!(gravity > 0.0) || !(measures.max_inverse_mass > 0.0)) return std::nullopt;
  return force_grain * measures.max_inverse_mass / gravity;
}

namespace {

Machine this_machine() {
  return {host_name(), processor_name(), static_cast<int>(std::thread::hardware_concurrency()), 1,
          mpi_library_version()};
}

}  // namespace

RunSummary summarize(Simulation& simulation, const std::string& deck,
                     const std::optional<StepLimit>& limit, bool interrupted) {
  const Model& model = simulation.model();
  const RunOptions& options = simulation.options();
  RunSummary summary;
  summary.version = version();
  summary.deck = deck;
  summary.title = model.title;
  summary.dimension = model.dimension;
  summary.ranks = simulation.communicator().size();
  summary.threads = options.threads;
  summary.cuts = simulation.cuts();
  summary.choice = simulation.exchange_choice();
  summary.exchange = summary.ranks > 1 ? summary.choice.name : options.exchange;
  summary.schedule = options.schedule == Schedule::Overlap ? "overlap" : "sequential";
  summary.progress = options.progress == Progress::Poll ? "poll" : "thread";
  const bool is_all_pairs =
      options.search.value_or(model.search.kind) == ContactSearchKind::AllPairs;
  summary.contact_search = is_all_pairs ? "all-pairs" : "cells";
  summary.vector = simulation.vector_width();
  summary.machine = this_machine();
  summary.particles = simulation.num_particles();
  summary.steps = simulation.step();
  summary.loop_steps = simulation.timings().steps;
  summary.dt = model.time.step;
  summary.time = simulation.time();
  summary.skin = simulation.skin();
  summary.force_grain = simulation.force_grain();
  summary.gravity = model.gravity.norm();
  summary.limit = limit;
  summary.measures = simulation.measure();
  if (model.output.energy) summary.budget = simulation.energy_budget(summary.measures);
  summary.wall_specs = model.walls;
  summary.walls.assign(simulation.walls().begin(), simulation.walls().end());
  summary.digest = simulation.digest();
  summary.left = simulation.left_domain();
  summary.interrupted = interrupted;
  const std::string mine = own_numbers(simulation);
  const auto of_ranks = simulation.communicator().gather(mine);
  add_numbers(of_ranks.empty() ? std::vector<std::string>{mine} : of_ranks, summary);
  return summary;
}

std::string version() {
  return BARCHAN_VERSION;
}

}  // namespace barchan
