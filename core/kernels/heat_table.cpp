#include <barchan/core/kernels/heat_table.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <barchan/core/kernels/law_table.hpp>
#include <barchan/core/model/mass.hpp>
#include <barchan/core/model/relative_speed.hpp>

namespace barchan {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// The particles of a material.
struct Made {
  double smallest = kInfinite, largest = 0.0;  ///< radius [m]
  double capacity = kInfinite;                 ///< the least heat capacity of one [J/K]
  [[nodiscard]] bool exists() const { return largest > 0.0; }
};

std::vector<Made> made_of(const Model& model, const ParticleSet& set) {
  std::vector<Made> made(model.materials.size());
  for (const ParticleData& p : set.particles) {
    Made& mine = made[static_cast<std::size_t>(p.type)];
    mine.smallest = std::min(mine.smallest, p.radius);
    mine.largest = std::max(mine.largest, p.radius);
    mine.capacity = std::min(mine.capacity,
                             mass_of(p, model.dimension) *
                                 model.materials[static_cast<std::size_t>(p.type)].heat_capacity);
  }
  return made;
}

/// Contacts as wide as limits.overlap_error lets them be.
class Widest {
 public:
  explicit Widest(const Model& model)
      : model_(model), laws_(model.contacts), heat_(model, ForceGrain{}) {}

  /// h [W/K] of two; of a particle at a wall. @param r, s  radii [m]; s = 0: a wall
  [[nodiscard]] double between(int a, double r, int b, double s) const {
    const double limit = model_.limits.overlap_error, share = std::isfinite(limit) ? limit : 2.0;
    const bool is_wall = s == 0.0;
    const Overlap overlap{share * (is_wall ? r : std::min(r, s)),
                          1.0 / r + (is_wall ? 0.0 : 1.0 / s), r + s};
    const double* row = laws_.row(laws_.code(a, b));
    const auto through = [&]<int Dim>(const ContactLawIn<Dim>& law) {
      return conductance<Dim>(heat_.between(a, b), std::sqrt(law.area(row, overlap)),
                              overlap.reach);
    };
    return model_.dimension == 2 ? through(laws_.law().disks) : through(laws_.law().spheres);
  }

 private:
  const Model& model_;
  LawTable laws_;
  HeatTable heat_;
};

/// Particles of radius s that fit around one of radius r, and more.
double most_around(double r, double s, int dimension) {
  const double ratio = 1.0 + r / s;
  return 4.0 * (dimension == 2 ? ratio : ratio * ratio);
}

/// By hundreds of impacts at once [K].
double largest_heating(const Model& model, const ParticleSet& set) {
  constexpr double kImpacts = 1000.0;
  const double speed = relative_speed(model, set);
  double capacity = kInfinite;
  for (const Material& m : model.materials) {
    if (m.heat_capacity > 0.0) capacity = std::min(capacity, m.heat_capacity);
  }
  return kImpacts * speed * speed / capacity;
}

/// Of the start and of walls, and what fluxes may add until the end [K].
double largest_difference(const Model& model, const ParticleSet& set,
                          const std::vector<Made>& made) {
  double low = model.heat.temperature, high = low, flux = 0.0, warming = 0.0;
  const auto take = [&](double t) { low = std::min(low, t), high = std::max(high, t); };
  for (const ParticleData& p : set.particles) {
    if (!std::isnan(p.temperature)) take(p.temperature);
  }
  for (const WallSpec& wall : model.walls) {
    if (wall.temperature) take(*wall.temperature);
    flux += std::abs(wall.heat_flux.value_or(0.0));
  }
  for (const Made& m : made) {
    if (m.exists()) warming = std::max(warming, m.largest * m.largest / m.capacity);
  }
  const double time = static_cast<double>(model.time.num_steps) * model.time.step;
  double difference = high - low + 4.0 * flux * warming * time;
  if (model.heat.dissipation) difference += largest_heating(model, set);
  return difference > 0.0 ? difference : 1.0;
}

/// Into a particle whose contacts are as strong as forces may be, and slide as fast as particles
/// are [W].
double largest_dissipation(const Model& model, const ParticleSet& set) {
  constexpr double kRoom = 16.0;
  return kRoom * force_grain(model, set).most() * relative_speed(model, set);
}

}  // namespace

HeatTable::HeatTable(const Model& model, const ForceGrain& of_flows) {
  if (!model.heat.is_on) return;
  is_on = true;
  dissipates = model.heat.dissipation;
  start = model.heat.temperature;
  grain = of_flows;
  num_materials = model.materials.size();
  for (const Material& a : model.materials) {
    heat_capacity.push_back(a.heat_capacity);
    for (const Material& b : model.materials) {
      const double sum = a.conductivity + b.conductivity;
      conductivity.push_back(sum > 0.0 ? 2.0 * a.conductivity * b.conductivity / sum : 0.0);
    }
  }
}

std::vector<HeatLimit> heat_limits(const Model& model, const ParticleSet& particles) {
  std::vector<HeatLimit> limits;
  if (!model.heat.is_on) return limits;
  const std::vector<Made> made = made_of(model, particles);
  const Widest widest(model);
  const double num_contacts = model.dimension == 2 ? 6.0 : 12.0;
  const int n = static_cast<int>(made.size());
  for (int a = 0; a < n; ++a) {
    const Made& mine = made[static_cast<std::size_t>(a)];
    if (!mine.exists()) continue;
    double most = 0.0;
    for (int b = 0; b < n; ++b) {
      const Made& other = made[static_cast<std::size_t>(b)];
      if (other.exists()) most = std::max(most, widest.between(a, mine.smallest, b, other.largest));
    }
    for (const WallSpec& wall : model.walls) {
      if (wall.temperature)
        most = std::max(most, widest.between(a, mine.smallest, wall.material, 0.0));
    }
    limits.push_back({a, mine.capacity / (num_contacts * most)});
  }
  return limits;
}

ForceGrain heat_grain(const Model& model, const ParticleSet& particles) {
  ForceGrain grain;
  if (!model.heat.is_on) return grain;
  const std::vector<Made> made = made_of(model, particles);
  const Widest widest(model);
  const int n = static_cast<int>(made.size());
  double most = 0.0;
  for (int a = 0; a < n; ++a) {
    const Made& mine = made[static_cast<std::size_t>(a)];
    for (int b = 0; b < n && mine.exists(); ++b) {
      const Made& other = made[static_cast<std::size_t>(b)];
      if (!other.exists()) continue;
      for (const double s : {other.smallest, other.largest})
        most = std::max(most, most_around(mine.largest, s, model.dimension) *
                                  widest.between(a, mine.largest, b, s));
    }
  }
  most *= largest_difference(model, particles, made);
  if (model.heat.dissipation) most += largest_dissipation(model, particles);
  if (!(most > 0.0) || !std::isfinite(most)) return grain;
  int exponent = 0;
  (void)std::frexp(most / ForceGrain{}.most(), &exponent);
  grain.size = std::ldexp(1.0, std::clamp(exponent, -1000, 900));
  return grain;
}

}  // namespace barchan
