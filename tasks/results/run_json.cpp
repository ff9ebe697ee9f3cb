#include <cmath>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <barchan/core/io/text_file.hpp>
#include <barchan/tasks/results/run_summary.hpp>

namespace barchan {
namespace {

using Json = nlohmann::ordered_json;

Json vector_of(const Vec3& v, int dimension) {
  Json json = Json::array();
  for (int c = 0; c < dimension; ++c) json.push_back(v[c]);
  return json;
}

Json walls_of(const RunSummary& s) {
  Json walls = Json::array();
  for (std::size_t w = 0; w < s.walls.size(); ++w) {
    const WallState& state = s.walls[w];
    const Json torque = s.dimension == 2 ? Json(state.torque.z()) : vector_of(state.torque, 3);
    walls.push_back({{"name", s.wall_specs[w].name},
                     {"active", state.is_active},
                     {"point", vector_of(state.point, s.dimension)},
                     {"velocity", vector_of(state.velocity, s.dimension)},
                     {"force", vector_of(state.force, s.dimension)},
                     {"torque", torque},
                     {"work", state.work}});
    if (s.wall_specs[w].gives_heat()) walls.back()["heat_flow"] = state.heat_flow;
  }
  return walls;
}

Json energy_of(const RunSummary& s) {
  return {{"kinetic", s.measures.kinetic.value()},
          {"potential", s.potential()},
          {"elastic", s.measures.elastic.value()},
          {"gravitational", s.measures.gravitational.value()}};
}

Json budget_of(const EnergyBudget& b) {
  return {{"wall_work", b.wall_work},       {"gravity_work", b.gravity_work},
          {"caller_work", b.caller_work},   {"contact_loss", b.contact_loss},
          {"dashpot_loss", b.dashpot_loss}, {"sliding_loss", b.sliding_loss},
          {"rolling_loss", b.rolling_loss}, {"bond_loss", b.bond_loss},
          {"damping_loss", b.damping_loss}, {"departed_energy", b.departed},
          {"energy_error", b.error}};
}

Json communication_of(const RunSummary& s) {
  Json json{{"in_flight_seconds", s.in_flight_seconds},
            {"exposed_seconds", s.exposed_seconds},
            {"exposed_seconds_most", s.exposed_most},
            {"hidden_fraction", s.hidden_fraction()},
            {"messages", s.messages},
            {"bytes", s.bytes},
            {"depth", s.cuts.depth}};
  if (s.cuts.depth > 0) json["redundant_seconds"] = s.phases.at("shadows");
  for (const auto& [name, time] : s.communication) {
    json[name] = {{"in_flight_seconds", time.in_flight}, {"exposed_seconds", time.exposed}};
    if (name != "reductions") json[name]["late_seconds"] = time.late;
  }
  return json;
}

/// Which exchange was taken and why; what was measured where that was by `auto`.
Json choice_of(const ExchangeChoice& choice) {
  Json json{{"name", choice.name}, {"reason", choice.reason}};
  if (!choice.hint.empty()) json["hint"] = choice.hint;
  if (!choice.is_measured) return json;
  json["message_bytes"] = choice.bytes;
  json["work_seconds"] = choice.work.seconds;
  json["seconds"] = choice.seconds;
  json["measured"] = Json::array();
  for (const ExchangeCandidate& c : choice.candidates) {
    if (c.obstacle.empty()) {
      json["measured"].push_back({{"exchange", c.name},
                                  {"exposed_seconds", c.exposed},
                                  {"half_round_trip_seconds", c.half_round_trip}});
    } else {
      json["measured"].push_back({{"exchange", c.name}, {"obstacle", c.obstacle}});
    }
  }
  return json;
}

Json momentum_of(const RunSummary& s) {
  const auto& p = s.measures.momentum;
  return vector_of(Vec3(p[0].value(), p[1].value(), p[2].value()), s.dimension);
}

Json machine_of(const RunSummary& s) {
  return {{"host", s.machine.host},
          {"hosts", s.machine.hosts},
          {"processor", s.machine.processor},
          {"cores", s.machine.cores},
          {"mpi", s.machine.mpi}};
}

/// The names of the contract, in its order.
Json contract_of(const RunSummary& s) {
  return {{"version", s.version},
          {"deck", s.deck},
          {"ranks", s.ranks},
          {"threads", s.threads},
          {"exchange", s.exchange},
          {"schedule", s.schedule},
          {"progress", s.progress},
          {"contact_search", s.contact_search},
          {"transport", s.transport},
          {"particles", s.particles},
          {"steps", s.steps},
          {"dt", s.dt},
          {"time", s.time},
          {"loop_seconds", s.loop_seconds},
          {"particle_steps_per_second", s.particle_steps_per_second()},
          {"contacts", s.measures.contacts},
          {"rebuilds", s.rebuilds},
          {"migrations", s.migrations},
          {"memory_bytes_per_particle",
           s.particles > 0 ? s.memory_bytes / static_cast<double>(s.particles) : 0.0},
          {"phases", s.phases},
          {"communication", communication_of(s)},
          {"energy", energy_of(s)},
          {"state_digest", fmt::format("{:016x}", s.digest)}};
}

void add_further(const RunSummary& s, Json& json) {
  json["interrupted"] = s.interrupted;
  const auto along_axes = [&](const std::array<int, 3>& counts) {
    return Json(std::vector<int>(counts.begin(), counts.begin() + s.dimension));
  };
  json["cuts"] = {{"form", s.cuts.are_strips ? "strips" : "bricks"},
                  {"ranks", along_axes(s.cuts.ranks)},
                  {"lanes", along_axes(s.cuts.lanes)},
                  {"imbalance", s.imbalance()}};
  json["loop_steps"] = s.loop_steps;
  json["exchange_choice"] = choice_of(s.choice);
  json["phases_most"] = s.phases_most;
  json["title"] = s.title;
  json["dimension"] = s.dimension;
  json["vector"] = s.vector;
  json["skin"] = s.skin;
  const auto share = s.grain_of_smallest_weight();
  json["force_grain"] = {{"newtons", s.force_grain},
                         {"of_smallest_weight", share ? Json(*share) : Json(nullptr)}};
  json["stable_step"] =
      s.limit ? Json{{"seconds", s.limit->step}, {"limit", s.limit->what}} : Json(nullptr);
  json["max_overlap"] = s.measures.max_overlap;
  json["max_overlap_share"] = s.measures.max_overlap_share;
  json["left_domain"] = {{"particles", s.left.particles},
                         {"contacts", s.left.links.contacts + s.left.links.wall_contacts},
                         {"bonds", s.left.links.bonds}};
  json["max_speed"] = s.measures.max_speed;
  if (s.budget) json["energy_budget"] = budget_of(*s.budget);
  if (std::isfinite(s.measures.max_temperature)) {
    json["heat"] = {{"total", s.measures.heat.value()},
                    {"mean_temperature", s.measures.mean_temperature()},
                    {"min_temperature", s.measures.min_temperature},
                    {"max_temperature", s.measures.max_temperature}};
  }
  json["momentum"] = momentum_of(s);
  json["bonds"] = s.measures.bonds;
  json["broken_bonds"] = s.measures.broken_bonds;
  json["walls"] = walls_of(s);
  json["particles_of_ranks"] = s.owned;
  json["machine"] = machine_of(s);
  json["deck_keys"] = Json::object();
  for (const auto& [key, value] : s.deck_keys) json["deck_keys"][key] = value;
}

}  // namespace

void write_run_json(const std::string& path, const RunSummary& summary) {
  Json json = contract_of(summary);
  add_further(summary, json);
  OutputFile file(path);
  file.write(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  file.commit();
}

}  // namespace barchan
