#include <barchan/tasks/stability.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/kernels/heat_table.hpp>
#include <barchan/core/model/relative_speed.hpp>
#include <barchan/tasks/step_limits.hpp>

namespace barchan {
namespace {

/// 1/m and 1/r of a particle, or of a flat wall.
struct Body {
  double inverse_mass = 0.0, inverse_radius = 0.0;
};

/// The two lightest particles of a material; fixed ones have 1/m = 0.
struct Lightest {
  std::optional<Body> first, second;

  void take(const Body& body) {
    const auto is_lighter = [&](const std::optional<Body>& than) {
      return !than || body.inverse_mass > than->inverse_mass;
    };
    if (is_lighter(first))
      second = std::exchange(first, body);
    else if (is_lighter(second))
      second = body;
  }
};

std::vector<Lightest> lightest_of(const Model& model, const ParticleSet& set) {
  std::vector<Lightest> lightest(model.materials.size());
  for (const ParticleData& p : set.particles)
    lightest[static_cast<std::size_t>(p.type)].take(
        {1.0 / mass_in_motion(p, model.dimension), 1.0 / p.radius});
  return lightest;
}

double reference_speed(const Model& model, const ParticleSet& set) {
  return model.contacts.reference_speed.value_or(relative_speed(model, set));
}

Impact impact_of(const Body& a, const Body& b, double speed) {
  return {1.0 / (a.inverse_mass + b.inverse_mass), 1.0 / (a.inverse_radius + b.inverse_radius),
          speed};
}

/// Two materials of which the lightest particles meet, or a particle meets a wall.
struct Encounter {
  std::string name;
  std::array<int, 2> materials;
  Impact impact;
  double smaller_radius = 0.0;
};

template <class Visit>
void for_each_encounter(const Model& model, const std::vector<Lightest>& lightest, double speed,
                        Visit&& visit) {
  const int n = static_cast<int>(model.materials.size());
  const auto name = [&](int a) { return model.materials[static_cast<std::size_t>(a)].name; };
  for (int a = 0; a < n; ++a) {
    const Lightest& mine = lightest[static_cast<std::size_t>(a)];
    if (!mine.first) continue;
    for (int b = a; b < n; ++b) {
      const auto& other = a == b ? mine.second : lightest[static_cast<std::size_t>(b)].first;
      if (!other) continue;
      visit(Encounter{name(a) + "–" + name(b),
                      {a, b},
                      impact_of(*mine.first, *other, speed),
                      1.0 / std::max(mine.first->inverse_radius, other->inverse_radius)});
    }
    for (const WallSpec& wall : model.walls) {
      visit(Encounter{name(a) + "–wall of " + name(wall.material),
                      {a, wall.material},
                      impact_of(*mine.first, {}, speed),
                      1.0 / mine.first->inverse_radius});
    }
  }
}

void add_contacts(const Model& model, const std::vector<Lightest>& lightest, double speed,
                  Limits& limits) {
  for_each_encounter(model, lightest, speed, [&](const Encounter& e) {
    if (!(e.impact.mass < kInfinite)) return;
    with_law(model.contacts.law, [&]<class Law>(Law /*law*/) {
      Law::for_each_motion(model.contacts.at(e.materials[0], e.materials[1]), e.impact,
                           spin_gain(model.dimension),
                           [&](const char* motion, double m, double k, double c) {
                             limits.add(motion + (" " + e.name), stable_step(m, k, c));
                           });
    });
  });
}

struct Touching {
  double count;
  std::size_t material;
  Impact impact;
};

/// A plate moves against all that touches it, each particle against the plate. With n equal
/// contacts the fastest of their motions is that of a mass 1/(n/M + 1/m) on one contact's spring.
void add_plate(const Model& model, const WallSpec& plate, const Touching& touching,
               Limits& limits) {
  const Impact& impact = touching.impact;
  const ContactConstants& pair =
      model.contacts.at(static_cast<int>(touching.material), plate.material);
  const double m = 1.0 / ((touching.count - 1.0) / plate.mass + 1.0 / impact.mass);
  const auto [k, c] = with_law(model.contacts.law, [&]<class Law>(Law /*law*/) {
    return std::pair(Law::stiffness(pair, impact), Law::dashpot(pair, impact));
  });
  limits.add(fmt::format("plate {} on {:.0f} of {}", plate.name, touching.count,
                         model.materials[touching.material].name),
             stable_step(m, k, c));
}

/// As many particles as fit side by side on both faces of a plate, if there are so many.
void add_plates(const Model& model, const ParticleSet& set, const std::vector<Lightest>& lightest,
                double speed, Limits& limits) {
  std::vector<double> counts(model.materials.size(), 0.0), radii(model.materials.size(), 0.0);
  for (const ParticleData& p : set.particles) {
    counts[static_cast<std::size_t>(p.type)] += 1.0;
    radii[static_cast<std::size_t>(p.type)] += p.radius;
  }
  for (const WallSpec& wall : model.walls) {
    if (!wall.is_loaded || !(wall.mass > 0.0)) continue;
    for (std::size_t a = 0; a < model.materials.size(); ++a) {
      if (counts[a] == 0.0) continue;
      const double width = 2.0 * radii[a] / counts[a];
      const double across = model.dimension == 3 ? std::floor(wall.depth / width) + 1.0 : 1.0;
      const double fit = 2.0 * (std::floor(wall.width / width) + 1.0) * across;
      add_plate(model, wall,
                {std::min(counts[a], fit), a,
                 impact_of(*lightest[a].first, {1.0 / wall.mass, 0.0}, speed)},
                limits);
    }
  }
}

/// Three digits, never more than the number itself.
double rounded_down(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - 2.0);
  return std::floor(x / unit) * unit;
}

}  // namespace

std::vector<StepLimit> step_limits(const Model& model, const ParticleSet& particles) {
  Limits limits;
  const std::vector<Lightest> lightest = lightest_of(model, particles);
  const double speed = reference_speed(model, particles);
  add_contacts(model, lightest, speed, limits);
  add_bonds(model, particles, limits);
  add_plates(model, particles, lightest, speed, limits);
  for (const HeatLimit& heat : heat_limits(model, particles))
    limits.add("heat in " + model.materials[static_cast<std::size_t>(heat.material)].name,
               heat.step, 1.0);
  return limits.sorted();
}

std::optional<ReferenceImpact> reference_impact(const Model& model, const ParticleSet& particles) {
  return with_law(
      model.contacts.law, [&]<class Law>(Law /*law*/) -> std::optional<ReferenceImpact> {
        if constexpr (!Law::kStiffens) return std::nullopt;
        ReferenceImpact found{reference_speed(model, particles), 0.0, kInfinite};
        for_each_encounter(
            model, lightest_of(model, particles), found.speed, [&](const Encounter& e) {
              const ContactConstants& pair = model.contacts.at(e.materials[0], e.materials[1]);
              if (!Law::acts(pair) || !(e.impact.mass < kInfinite) || !(found.speed > 0.0)) return;
              const double overlap = Law::struck_overlap(pair, e.impact);
              found.overlap = std::max(found.overlap, overlap / e.smaller_radius);
              found.duration = std::min(found.duration, Law::duration(pair, e.impact));
            });
        if (!(found.duration < kInfinite)) return std::nullopt;
        return found;
      });
}

std::vector<StepLimit> wave_times(const Model& model, const ParticleSet& particles) {
  Limits limits;
  with_law(model.contacts.law, [&]<class Law>(Law /*law*/) {
    for (const ParticleData& p : particles.particles) {
      const double time = Law::wave_time(model.contacts.at(p.type, p.type), p.radius, p.density);
      if (time > 0.0) limits.add(model.materials[static_cast<std::size_t>(p.type)].name, time);
    }
  });
  return limits.sorted();
}

const StepLimit& tightest(std::span<const StepLimit> limits) {
  return *std::min_element(
      limits.begin(), limits.end(),
      [](const StepLimit& a, const StepLimit& b) { return a.safe() < b.safe(); });
}

void check_time_step(const Model& model, std::span<const StepLimit> limits) {
  if (limits.empty() || model.time.allow_unstable || model.time.step <= limits.front().step) return;
  throw InputError(
      model.time.place,
      fmt::format("time.step = {:g} s is unstable: the limit is {:.3g} s ({})", model.time.step,
                  limits.front().step, limits.front().what),
      fmt::format("use at most {:.3g} s, better {:.2g} s, or set time.allow_unstable = true",
                  rounded_down(limits.front().step), tightest(limits).safe()));
}

}  // namespace barchan
