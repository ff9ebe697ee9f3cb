#include <barchan/tasks/forecast.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/model/mass.hpp>

namespace barchan {
namespace {

constexpr double kSkinShare = 0.3, kSpeedMargin = 1.05;
constexpr double kOneDigit = 10.0, kThreeDigits = 1000.0;
/// An overlap of interest is at least this share of a radius.
constexpr double kLeastOverlap = 1e-3;

/// Of a particle under its weight, or as it hits something heavy, where that overlaps least; 0
/// without constants [m].
double overlap_of(const Model& model, const ParticleData& p) {
  const double m = mass_of(p, model.dimension), g = model.gravity.norm();
  double least = kInfinite;
  with_law(model.contacts.law, [&]<class Law>(Law /*law*/) {
    for (int other = 0; other < model.contacts.num_materials; ++other) {
      const ContactConstants& pair = model.contacts.at(p.type, other);
      if (!Law::acts(pair)) continue;
      least =
          std::min(least, std::max(Law::pressed_overlap(pair, p.radius, m * g),
                                   Law::struck_overlap(pair, {m, p.radius, p.velocity.norm()})));
    }
  });
  return least < kInfinite ? least : 0.0;
}

/// How far a particle may fall before it leaves the domain [m]; infinite along a periodic axis, 0
/// without gravity.
double fall_height(const Model& model, const Vec3& position) {
  const double g = model.gravity.norm();
  double height = g > 0.0 ? kInfinite : 0.0;
  for (int axis = 0; axis < model.dimension && g > 0.0; ++axis) {
    const double down = model.gravity[axis] / g;
    if (down == 0.0 || model.domain.periodic[static_cast<std::size_t>(axis)]) continue;
    const double end = down > 0.0 ? model.domain.hi[axis] : model.domain.lo[axis];
    height = std::min(height, std::max(0.0, (end - position[axis]) / down));
  }
  return height;
}

struct Fastest {
  const ParticleData* particle = nullptr;
  double speed = 0.0, height = 0.0;

  void take(const ParticleData& p, double its_speed, double its_height) {
    if (its_speed > speed) particle = &p, speed = its_speed, height = its_height;
  }
};

/// At the start, and after a fall to the end of the domain.
struct Speeds {
  Fastest start, fall;
  const ParticleData* smallest = nullptr;
};

Speeds speeds_of(const Model& model, const ParticleSet& set) {
  Speeds found;
  for (const ParticleData& p : set.particles) {
    if (found.smallest == nullptr || p.radius < found.smallest->radius) found.smallest = &p;
    if (p.fixed) continue;
    const double speed = p.velocity.norm(), height = fall_height(model, p.position);
    found.start.take(p, speed, 0.0);
    if (height < kInfinite)
      found.fall.take(p, std::sqrt(speed * speed + 2.0 * model.gravity.norm() * height), height);
  }
  return found;
}

std::string two_digits_down(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - 1.0);
  return fmt::format("{:.2g}", std::floor(x / unit) * unit);
}

/// What comes of something so fast; empty: nothing.
std::string consequence(const Model& model, double speed, double skin,
                        const ParticleData& smallest) {
  const double travel = speed * model.time.step, radius = smallest.radius;
  const double most = 0.5 * std::max(skin, radius);
  if (travel <= std::min(most, radius)) return {};
  const bool ends = travel > most;
  return fmt::format(
      "{:.3g} m a step, more than {}the smallest radius ({:.3g} m, of particle {}){}; with "
      "time.step "
      "= {} or less no contact is skipped",
      travel, ends ? "half of " : "", radius, smallest.id,
      ends ? fmt::format(" and half of the skin ({:.3g} m): the run ends where it is so fast", skin)
           : ": the run ends where a plate or a particle would be passed",
      two_digits_down((ends ? 0.5 : 1.0) * radius / speed));
}

/// The part of an axis' coordinates that could be taken off them, to few digits.
double offset(double lo, double hi) {
  const double middle = 0.5 * (lo + hi), size = std::max(hi - lo, 1e-300);
  if (std::fabs(middle) <= size) return 0.0;
  const double unit = std::pow(10.0, std::floor(std::log10(size)));
  return std::rint(middle / unit) * unit;
}

std::string remedy(const Model& model) {
  std::string by;
  bool is_far = false;
  for (int axis = 0; axis < model.dimension; ++axis) {
    const double far = offset(model.domain.lo[axis], model.domain.hi[axis]);
    is_far |= far != 0.0;
    by += fmt::format("{}{:.15g}", axis == 0 ? "" : ", ", far);
  }
  if (!is_far) return "a smaller domain or a larger time.step would help";
  return fmt::format(
      "subtract ({}) from all positions of the deck (domain, particles, walls), so that they lie "
      "about the origin",
      by);
}

/// What is too small for the spacing, with so many times the spacing as the least; empty: nothing.
/// @param is_strict  whether to look at what is smallest of all
std::string too_small(const Precision& p, double times, bool is_strict) {
  const double least = times * p.spacing;
  const double overlap = is_strict ? p.least_overlap : p.most_overlap;
  if (p.travel > 0.0 && p.travel < least)
    return fmt::format("the fastest motion is {:.2g} m a step", p.travel);
  if (overlap > 0.0 && overlap < least) return fmt::format("overlaps are about {:.2g} m", overlap);
  if (kLeastOverlap * p.radius < least)
    return fmt::format("the smallest radius is {:.2g} m", p.radius);
  return {};
}

std::string where(const Precision& p) {
  return fmt::format("coordinates reach {:.4g} m, where numbers are {:.2g} m apart", p.coordinate,
                     p.spacing);
}

}  // namespace

double default_skin(const Model& model, const ParticleSet& set) {
  if (set.particles.empty()) return 0.0;
  double sum = 0.0;
  for (const ParticleData& p : set.particles) sum += p.radius;
  const double mean = sum / static_cast<double>(set.particles.size()), usual = kSkinShare * mean;
  const Speeds speeds = speeds_of(model, set);
  double fastest = std::max(speeds.start.speed, speeds.fall.speed);
  for (const WallSpec& wall : model.walls) fastest = std::max(fastest, wall.velocity.norm());
  const double needed = kSpeedMargin * 2.0 * fastest * model.time.step;
  if (needed <= speeds.smallest->radius) return usual;  // no contact is skipped
  return std::clamp(needed, usual, 2.0 * mean);
}

std::vector<std::string> speed_warnings(const Model& model, const ParticleSet& set) {
  std::vector<std::string> warnings;
  const Speeds speeds = speeds_of(model, set);
  if (speeds.smallest == nullptr) return warnings;
  const double skin = model.search.skin.value_or(default_skin(model, set));
  const auto warn = [&](double speed, const auto& who) {
    const std::string what = consequence(model, speed, skin, *speeds.smallest);
    if (!what.empty()) warnings.push_back(who() + ", " + what);
  };
  warn(speeds.start.speed, [&start = speeds.start] {
    return fmt::format("particle {} starts at {:.3g} m/s", start.particle->id, start.speed);
  });
  if (warnings.empty())
    warn(speeds.fall.speed, [&fall = speeds.fall] {
      return fmt::format(
          "particle {}, if it falls to the end of the domain ({:.3g} m), gets {:.3g} m/s",
          fall.particle->id, fall.height, fall.speed);
    });
  for (const WallSpec& wall : model.walls) {
    const double speed = wall.velocity.norm();
    if (wall.kind == WallKind::Plate)
      warn(speed, [&] { return fmt::format("wall '{}' moves at {:.3g} m/s", wall.name, speed); });
  }
  return warnings;
}

Precision precision_of(const Model& model, const ParticleSet& set) {
  Precision found;
  for (int axis = 0; axis < model.dimension; ++axis)
    found.coordinate = std::max(
        {found.coordinate, std::fabs(model.domain.lo[axis]), std::fabs(model.domain.hi[axis])});
  found.spacing = std::nextafter(found.coordinate, kInfinite) - found.coordinate;
  found.radius = found.least_overlap = kInfinite;
  const double g = model.gravity.norm();
  double speed = 0.0;
  for (const WallSpec& wall : model.walls) speed = std::max(speed, wall.velocity.norm());
  for (const ParticleData& p : set.particles) {
    found.radius = std::min(found.radius, p.radius);
    if (p.fixed) continue;
    speed = std::max({speed, p.velocity.norm(), std::sqrt(2.0 * g * p.radius)});
    const double overlap = overlap_of(model, p);
    found.most_overlap = std::max(found.most_overlap, overlap);
    if (overlap > 0.0) found.least_overlap = std::min(found.least_overlap, overlap);
  }
  if (found.least_overlap == kInfinite) found.least_overlap = 0.0;
  found.travel = speed * model.time.step;
  return found;
}

std::vector<std::string> precision_warnings(const Model& model, const ParticleSet& set) {
  const Precision p = precision_of(model, set);
  const std::string what = too_small(p, kThreeDigits, true);
  if (what.empty()) return {};
  return {fmt::format("{}: {}, of which fewer than three digits remain; {}", where(p), what,
                      remedy(model))};
}

void check_precision(const Model& model, const ParticleSet& set) {
  const Precision p = precision_of(model, set);
  const std::string what = too_small(p, kOneDigit, false);
  if (what.empty()) return;
  throw InputError(
      model.domain.place,
      fmt::format("{}: {}, so that nothing would move or touch rightly", where(p), what),
      remedy(model));
}

}  // namespace barchan
