#include <barchan/core/kernels/force_grain.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include <barchan/core/model/mass.hpp>
#include <barchan/core/model/relative_speed.hpp>

namespace barchan {
namespace {

/// The largest particle of a material; radius 0 where there is none.
struct Largest {
  double radius = 0.0, mass = 0.0;
};

std::vector<Largest> largest_of(const Model& model, const ParticleSet& set) {
  std::vector<Largest> largest(model.materials.size());
  for (const ParticleData& p : set.particles) {
    Largest& mine = largest[static_cast<std::size_t>(p.type)];
    mine.radius = std::max(mine.radius, p.radius);
    mine.mass = std::max(mine.mass, mass_of(p, model.dimension));
  }
  return largest;
}

/// Of the smaller radius; without a limit the centres meet.
double largest_share(double overlap_limit) {
  return std::isfinite(overlap_limit) ? overlap_limit : 2.0;
}

/// What a particle may have to bear at once: as many contacts as neighbours fit around it, each
/// with half of the largest overlap; or one impact.
double largest_sum(const ContactConstants& pair, const Largest& a, const Largest& b, double speed,
                   const Model& model) {
  const bool is_flat = model.dimension == 2;
  const Impact impact{a.mass * b.mass / (a.mass + b.mass),
                      a.radius * b.radius / (a.radius + b.radius), speed};
  const double overlap = largest_share(model.limits.overlap_error) * std::min(a.radius, b.radius);
  return with_law(model.contacts.law, [&]<class Law>(Law /*law*/) {
    return Law::largest_force(pair, is_flat ? 3.0 : 6.0, overlap, impact);
  });
}

}  // namespace

ForceGrain force_grain(const Model& model, const ParticleSet& particles) {
  const std::vector<Largest> largest = largest_of(model, particles);
  const double speed = relative_speed(model, particles);
  const int n = static_cast<int>(model.materials.size());
  double most = 0.0;
  for (int a = 0; a < n; ++a) {
    for (int b = a; b < n; ++b) {
      const Largest &p = largest[static_cast<std::size_t>(a)],
                    &q = largest[static_cast<std::size_t>(b)];
      if (p.radius > 0.0 && q.radius > 0.0)
        most = std::max(most, largest_sum(model.contacts.at(a, b), p, q, speed, model));
    }
  }
  ForceGrain grain;
  if (!(most > 0.0) || !std::isfinite(most)) return grain;
  int exponent = 0;
  (void)std::frexp(most / ForceGrain{}.most(), &exponent);
  grain.size = std::ldexp(1.0, std::clamp(exponent, -1000, 900));
  return grain;
}

ForceGrain grain_for_limit(const ForceGrain& grain, double limit_before, double limit_now) {
  const double ratio = largest_share(limit_now) / largest_share(limit_before);
  if (!(ratio > 1.0)) return grain;
  int exponent = 0;
  (void)std::frexp(ratio, &exponent);
  return {std::ldexp(grain.size, exponent)};
}

double smallest_mass(const Model& model, const ParticleSet& particles) {
  double mass = std::numeric_limits<double>::infinity();
  for (const ParticleData& p : particles.particles) {
    if (!p.fixed) mass = std::min(mass, mass_of(p, model.dimension));
  }
  return mass;
}

std::string describe(const ForceGrain& grain, const Model& model, const ParticleSet& particles) {
  const double mass = smallest_mass(model, particles), gravity = model.gravity.norm();
  std::string text = fmt::format("{:.3g} N", grain.size);
  if (!std::isfinite(mass)) return text;
  if (gravity > 0.0)
    return text + fmt::format(", {:.2g} of the smallest weight", grain.size / (mass * gravity));
  return text +
         fmt::format(", {:.2g} m/s² to the lightest particle (no gravity)", grain.size / mass);
}

std::string coarse_grain_warning(const ForceGrain& grain, const Model& model,
                                 const ParticleSet& particles) {
  constexpr double kCoarse = 1e-4;
  const double weight = smallest_mass(model, particles) * model.gravity.norm();
  if (!(weight > 0.0) || !(grain.size > kCoarse * weight)) return {};
  return fmt::format(
      "contact forces are rounded to {:.3g} N, {:.2g} of the smallest weight: the stiffest contact "
      "of the largest particles is too strong for the lightest; soften it, or lower "
      "limits.overlap_error, where such overlaps never occur",
      grain.size, grain.size / weight);
}

}  // namespace barchan
