#include <barchan/tasks/particle_view.hpp>

#include <fmt/format.h>

namespace barchan {

void Generation::require(std::uint64_t then, const char* what) const {
  if (*value_ == then) [[likely]]
    return;
  if (*value_ == kGone)
    throw StaleView(fmt::format("a view of {} was used after its simulation was gone", what));
  throw StaleView(
      fmt::format("a view of {} was used after rows had moved (generation {}, now {}): take a new "
                  "one from the simulation",
                  what, then, *value_));
}

Vec3 ParticleView::angular_velocity(std::size_t i) const {
  const BrickArrays& a = fresh();
  const double* u = a.surface_speeds[i];
  const double r = *a.radii[i];
  if (a.surface_speeds.width() == 1) return {0.0, 0.0, u[0] / r};
  return {u[0] / r, u[1] / r, u[2] / r};
}

double ParticleView::mass(std::size_t i) const {
  const double inverse = *fresh().inverse_masses[i];
  return inverse > 0.0 ? 1.0 / inverse : std::numeric_limits<double>::infinity();
}

LoadView ParticleView::loads() const {
  (void)fresh();
  return source_->loads_of(brick_);
}

StridedSpan<double> ParticleView::field(const std::string& name) const {
  (void)fresh();
  return source_->field_of(brick_, name);
}

void LoadView::set(std::size_t i, const Vec3& force, const Vec3& torque) const {
  generation_.require(then_, "loads");
  double *f = forces_[i], *t = torques_by_radius_[i];
  const double r = *radii_[i];
  for (int c = 0; c < forces_.width(); ++c) f[c] = force[c];
  const int turns = torques_by_radius_.width();
  for (int c = 0; c < turns; ++c) t[c] = torque[turns == 1 ? 2 : c] / r;
}

int width_of(ParticleField field) {
  switch (field) {
    case ParticleField::Radius:
    case ParticleField::Mass:
    case ParticleField::Type:
    case ParticleField::Temperature:
      return 1;
    default:
      return 3;
  }
}

}  // namespace barchan
