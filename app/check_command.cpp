#include <algorithm>
#include <cstdio>
#include <limits>
#include <map>

#include <fmt/format.h>

#include <barchan/app/check_contacts.hpp>
#include <barchan/app/commands.hpp>
#include <barchan/app/loaded_deck.hpp>
#include <barchan/app/readable.hpp>
#include <barchan/app/warning.hpp>
#include <barchan/core/generators/check_walls.hpp>
#include <barchan/core/kernels/force_grain.hpp>
#include <barchan/core/kernels/heat_table.hpp>
#include <barchan/core/model/mass.hpp>
#include <barchan/tasks/forecast.hpp>
#include <barchan/tasks/memory_estimate.hpp>
#include <barchan/tasks/stability.hpp>
#include <barchan/tasks/strip_plan.hpp>

namespace barchan::app {
namespace {

using Rows = std::vector<std::vector<std::string>>;

std::string kind_of(const ParticleSource& source) {
  static constexpr const char* kNames[] = {"file", "lattice", "packing", "ring", "list"};
  return kNames[source.kind.index()];
}

/// Radii and masses of some particles.
struct Extent {
  std::int64_t count = 0, fixed = 0;
  double radius_lo = 1e300, radius_hi = 0.0, mass_lo = 1e300, mass_hi = 0.0, mass = 0.0;

  void take(const ParticleData& p, int dimension) {
    const double m = mass_of(p, dimension);
    ++count;
    fixed += p.fixed ? 1 : 0;
    radius_lo = std::min(radius_lo, p.radius);
    radius_hi = std::max(radius_hi, p.radius);
    mass_lo = std::min(mass_lo, m);
    mass_hi = std::max(mass_hi, m);
    mass += m;
  }
};

void print_particles(const LoadedDeck& loaded) {
  const Model& model = loaded.deck.model;
  Rows rows{{"source", "material", "particles", "radius [m]", "mass [kg]", "sum [kg]", "fixed"}};
  for (std::size_t s = 0; s < loaded.deck.sources.size(); ++s) {
    std::map<std::int32_t, Extent> by_type;
    for (std::size_t i = loaded.begins[s]; i < loaded.begins[s + 1]; ++i) {
      const ParticleData& p = loaded.particles.particles[i];
      by_type[p.type].take(p, model.dimension);
    }
    for (const auto& [type, e] : by_type) {
      rows.push_back({fmt::format("{} {}", s + 1, kind_of(loaded.deck.sources[s])),
                      model.materials[static_cast<std::size_t>(type)].name, grouped(e.count),
                      range(e.radius_lo, e.radius_hi), range(e.mass_lo, e.mass_hi),
                      fmt::format("{:.4g}", e.mass), e.fixed > 0 ? grouped(e.fixed) : ""});
    }
  }
  std::printf("Particles: %s %s, %s bonds\n%s",
              grouped(static_cast<std::int64_t>(loaded.particles.particles.size())).c_str(),
              model.dimension == 2 ? "disks" : "spheres",
              grouped(static_cast<std::int64_t>(loaded.particles.bonds.size())).c_str(),
              table(rows, 2).c_str());
}

void print_grain(const Model& model, const ParticleSet& particles) {
  const ForceGrain grain = force_grain(model, particles);
  std::printf("  Forces are rounded to %s; sums are exact up to %.3g N.\n",
              describe(grain, model, particles).c_str(), grain.most());
  const std::string warning = coarse_grain_warning(grain, model, particles);
  if (!warning.empty()) std::printf("  Warning: %s.\n", warning.c_str());
}

void print_heat(const Model& model, const ParticleSet& particles) {
  if (!model.heat.is_on) return;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const ParticleData& p : particles.particles)
    low = std::min(low, p.temperature), high = std::max(high, p.temperature);
  Rows rows{{"material", "conductivity [W/(m·K)]", "heat capacity [J/(kg·K)]"}};
  const auto text = [](double value) { return value > 0.0 ? fmt::format("{:.4g}", value) : "–"; };
  for (const Material& m : model.materials)
    rows.push_back({m.name, text(m.conductivity), text(m.heat_capacity)});
  std::printf("Heat: conduction through contacts, %s K at the start\n%s",
              low == high ? fmt::format("{:g}", low).c_str()
                          : fmt::format("{:g} … {:g}", low, high).c_str(),
              table(rows).c_str());
  const ForceGrain grain = heat_grain(model, particles);
  std::printf("  Flows are rounded to %.3g W; sums are exact up to %.3g W.\n", grain.size,
              grain.most());
}

void print_walls(const Model& model) {
  if (model.walls.empty()) return;
  Rows rows;
  for (const WallSpec& wall : model.walls) {
    std::string what = wall.kind == WallKind::Plane ? "plane" : "plate";
    if (wall.is_loaded)
      what += fmt::format(", load {:.4g} {}, mass {:.4g} kg", wall.load,
                          model.dimension == 2 ? "N/m" : "N/m²", wall.mass);
    else if (!wall.velocity.isZero())
      what += fmt::format(", moves at {:.4g} m/s", wall.velocity.norm());
    if (wall.temperature) what += fmt::format(", at {:g} K", *wall.temperature);
    if (wall.heat_flux) what += fmt::format(", gives {:g} W/m²", *wall.heat_flux);
    if (wall.from_stage > 0)
      what += ", from stage " + model.stages[static_cast<std::size_t>(wall.from_stage)].name;
    rows.push_back(
        {wall.name, model.materials[static_cast<std::size_t>(wall.material)].name, what});
  }
  std::printf("Walls:\n%s", table(rows, 3).c_str());
}

/// In one line of a table, for so many ranks of one thread.
std::vector<std::string> row_of_ranks(const CutPlan& plan, const CutShape& shape, double bytes_each,
                                      double bytes_of_all) {
  const auto counts = plan.rank_counts(shape);
  const auto [lo, hi] = std::minmax_element(counts.begin(), counts.end());
  const std::string few = grouped(*lo), many = grouped(*hi);
  const auto num_particles = static_cast<double>(plan.cells.size());
  return {std::to_string(shape.num_ranks()), describe(shape, plan.room),
          few == many ? few : few + " … " + many,
          fmt::format("{:.2f}", static_cast<double>(*hi) * shape.num_ranks() / num_particles),
          readable_bytes(bytes_each * static_cast<double>(*hi) + bytes_of_all)};
}

void print_depth(const Model& model, const CutRoom& room, int wanted) {
  if (model.exchange.depth == 0) return;
  std::string fits;
  for (const int p : wanted > 1 ? std::vector<int>{wanted} : std::vector<int>{2, 4, 8}) {
    fits += fmt::format("{}{}{} with {}{}", fits.empty() ? "at most " : ", ", most_depth(p, room),
                        fits.empty() ? " fit" : "", p, fits.empty() ? " ranks" : "");
  }
  std::printf("  Shadows: a depth of %d; %s\n", model.exchange.depth, fits.c_str());
  if (std::ranges::any_of(model.walls, &WallSpec::is_loaded))
    std::printf(
        "  While a loaded plate is active, each step waits for the forces on it, at any "
        "depth.\n");
}

void print_cuts(const LoadedDeck& loaded, int wanted) {
  const Model& model = loaded.deck.model;
  const CutPlan plan = plan_cuts(model, loaded.particles);
  const double bytes = static_cast<double>(memory_estimate(model, loaded.particles)) /
                       static_cast<double>(loaded.particles.particles.size());
  const auto all =
      static_cast<double>(loaded.particles.particles.capacity() * sizeof(ParticleData) +
                          loaded.particles.bonds.capacity() * sizeof(BondData));
  // A deck that asks for bricks is for one number of ranks.
  CutRequest request{model.domain.cuts, wanted, 1, false, model.domain.place};
  request.depth = model.exchange.depth;
  request.depth_place = model.exchange.place;
  const auto most_bricks = static_cast<std::int64_t>(plan.room.num_cells());
  std::vector<int> ranks{1, 2, 4, 8, 16, 32};
  if (wanted > 0) {
    ranks = {wanted};
  } else if (model.domain.cuts.kind == CutWish::Kind::Bricks) {
    request.wish.kind = CutWish::Kind::Auto;
  }
  Rows rows{{"ranks", "cut into", "particles a rank", "largest / mean", "memory a rank"}};
  for (const int p : ranks) {
    if (wanted == 0 && (!fits_somehow(p, request.wish.kind, plan.room) ||
                        (p > 1 && most_depth(p, plan.room) < request.depth)))
      continue;
    request.ranks = p;
    rows.push_back(row_of_ranks(plan, choose_cuts(request, plan.room), bytes, all));
  }
  const auto cells = along_xyz(plan.room.cells, plan.room);
  std::string grid = fmt::format("{} x {}", cells[0], cells[1]);
  if (model.dimension == 3) grid += fmt::format(" x {}", cells[2]);
  std::printf(
      "Cuts: %s cells, %.3g m long along %c; at most %d ranks fit as strips, %s as bricks\n%s",
      grid.c_str(), plan.cell[0], "xyz"[plan.room.axes[0]], plan.room.most_strips(),
      grouped(most_bricks).c_str(), table(rows).c_str());
  print_depth(model, plan.room, wanted);
  std::printf(
      "  Memory: %.0f bytes a particle at the start, up to twice that when packed, and %s a rank "
      "for "
      "set-up.\n",
      bytes, readable_bytes(all).c_str());
  std::printf("  Contact search: %s, skin %.3g m\n",
              model.search.kind == ContactSearchKind::Cells ? "cells" : "all-pairs",
              model.search.skin.value_or(default_skin(model, loaded.particles)));
}

void print_stages(const Model& model) {
  const double whole = static_cast<double>(model.time.num_steps) * model.time.step;
  double most = 0.0;  // of all stages
  bool may_be_shorter = false;
  for (const Stage& stage : model.stages) {
    most += stage.max_time;
    may_be_shorter |= stage.kinetic_ratio > 0.0;
  }
  if (most < whole || (may_be_shorter && model.stages.back().kinetic_ratio > 0.0)) {
    std::printf("Run: at most %.6g s in steps of %g s, to the end of the last stage\n",
                std::min(most, whole), model.time.step);
  } else {
    std::printf("Run: %s steps of %g s, %.6g s in all\n", grouped(model.time.num_steps).c_str(),
                model.time.step, whole);
  }
  Rows rows;
  for (const Stage& stage : model.stages) {
    std::string until = "to the end";
    if (stage.max_time < 1e300) until = fmt::format("at most {:g} s", stage.max_time);
    if (stage.kinetic_ratio > 0.0)
      until +=
          fmt::format(", or until the kinetic-energy ratio is below {:g}", stage.kinetic_ratio);
    const std::string damping = stage.local_damping > 0.0
                                    ? fmt::format("local damping {:g}", stage.local_damping)
                                    : "no local damping";
    rows.push_back({stage.name.empty() ? "(one stage)" : stage.name, until, damping});
  }
  std::fputs(table(rows, 3).c_str(), stdout);
}

void print_step(const Model& model, const std::vector<StepLimit>& limits) {
  constexpr std::size_t kMost = 12;
  Rows rows{{"limit", "largest step [s]", "chosen / largest"}};
  for (std::size_t i = 0; i < std::min(kMost, limits.size()); ++i) {
    rows.push_back({limits[i].what, fmt::format("{:.3g}", limits[i].step),
                    fmt::format("{:.3g}", model.time.step / limits[i].step)});
  }
  std::printf("Stable step: chosen %g s\n%s", model.time.step, table(rows).c_str());
  if (limits.size() > kMost) std::printf("  and %zu larger limits\n", limits.size() - kMost);
  if (limits.empty()) return;
  const double share = model.time.step / limits.front().step;
  if (share > 1.0 && model.time.allow_unstable) {
    std::printf("  Warning: the step is beyond the limit; time.allow_unstable allows that.\n");
    return;
  }
  const StepLimit& tight = tightest(limits);
  const bool has_heat = std::any_of(limits.begin(), limits.end(),
                                    [](const StepLimit& l) { return l.safe_share == 1.0; });
  if (share <= 1.0 && model.time.step > tight.safe()) {
    std::printf("  Warning: the step is %s of its limit (%s); a fifth of it is safe: %.2g s.\n",
                percent(model.time.step / tight.step).c_str(), tight.what.c_str(), tight.safe());
  } else if (share <= 1.0) {
    std::printf("  The step is within a fifth of every limit%s.\n",
                has_heat ? ", of heat within all of it" : "");
  }
}

/// What the limits of contacts that stiffen with overlap rest on, and what is custom beside them.
void print_impact(const LoadedDeck& loaded) {
  const Model& model = loaded.deck.model;
  if (const auto impact = reference_impact(model, loaded.particles)) {
    std::printf(
        "  Contacts are as stiff there as an impact at %.3g m/s (%s) makes them: overlap %s of the "
        "smaller radius; the shortest takes %.3g s, %.0f steps.\n",
        impact->speed,
        model.contacts.reference_speed ? "contact.reference_speed" : "of the start and of falls",
        percent(impact->overlap).c_str(), impact->duration, impact->duration / model.time.step);
  }
  const auto waves = wave_times(model, loaded.particles);
  if (waves.empty()) return;
  const double share = model.time.step / waves.front().step;
  std::printf("  %sRayleigh time %.3g s (%s): the step is %.2g of it%s.\n",
              share > kAdvisedShare ? "Warning: " : "", waves.front().step,
              waves.front().what.c_str(), share,
              share > kAdvisedShare ? "; a fifth is the custom" : "");
}

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& what : warnings) std::printf("  Warning: %s.\n", what.c_str());
}

}  // namespace

void check_deck(const CheckArguments& arguments) {
  const LoadedDeck loaded = load_deck(arguments.deck, arguments.settings);
  const Model& model = loaded.deck.model;
  const auto limits = step_limits(model, loaded.particles);
  for (const std::string& note : loaded.particles.notes) print_warning(note);
  std::printf("%s%s%s\n", arguments.deck.c_str(), model.title.empty() ? "" : ": ",
              model.title.c_str());
  print_particles(loaded);
  print_contacts(loaded);
  print_grain(model, loaded.particles);
  print_heat(model, loaded.particles);
  print_walls(model);
  print_warnings(walls_to_come_in_particles(model, loaded.particles));
  print_stages(model);
  print_step(model, limits);
  print_impact(loaded);
  print_warnings(speed_warnings(model, loaded.particles));
  print_warnings(precision_warnings(model, loaded.particles));
  print_cuts(loaded, arguments.ranks);
  std::fflush(stdout);
  check_precision(model, loaded.particles);
  check_time_step(model, limits);
}

}  // namespace barchan::app
