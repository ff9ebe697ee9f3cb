#include <barchan/core/brick/passage.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace barchan {
namespace {

/// The least value of a convex function on [0, 1].
template <class F>
double least(const F& f) {
  double begin = 0.0, end = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double third = (end - begin) / 3.0;
    if (f(begin + third) < f(end - third))
      end -= third;
    else
      begin += third;
  }
  return std::min({f(0.0), f(begin), f(1.0)});
}

/// Distances of two on the straight line of a step, and the sum of their radii.
struct Course {
  double begin, nearest, end, reach;
  /// They came into contact in this step, and part already: a dashpot would see nothing else.
  [[nodiscard]] bool skips_approach() const {
    return begin >= reach && nearest < reach && nearest < 0.999 * end;
  }
};

/// Whether a contact that began in this step pushes in another direction, by more than 60 degrees,
/// than it did when it began: a plate's end was skipped.
/// @param foot  of the plate, at a share of the step before its end
template <class Foot>
bool turns(const Foot& foot, const Course& course) {
  if (course.begin < course.reach || course.end >= course.reach) return false;
  double apart = 1.0, touching = 0.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (apart + touching);
    (foot(middle).distance < course.reach ? touching : apart) = middle;
  }
  const WallFoot first = foot(touching), last = foot(0.0);
  double along = 0.0;
  for (int c = 0; c < 3; ++c) along += first.to_foot[c] * last.to_foot[c];
  return along < 0.5 * first.distance * last.distance;
}

/// @param d  from one to the other as the step ended  @param s  how that has changed in the step
template <int Dim>
Course course_of(const double* d, const double* s, double reach) {
  double dd = 0.0, ds = 0.0, ss = 0.0;
  for (int c = 0; c < Dim; ++c) dd += d[c] * d[c], ds += d[c] * s[c], ss += s[c] * s[c];
  const double back = std::clamp(ds / ss, 0.0, 1.0);  // share of the step before its end
  const auto at = [&](double t) { return std::sqrt(std::max(0.0, dd - t * (2.0 * ds - t * ss))); };
  return {at(1.0), at(back), at(0.0), reach};
}

}  // namespace

template <int Dim>
double step_travel(const ParticleStore<Dim>& store, double dt, std::int32_t row) {
  const double *x = store.x(row), *v = store.v(row), *u = store.u(row);
  double v2 = 0.0, zero = 0.0;
  for (int c = 0; c < Dim; ++c) v2 += v[c] * v[c], zero += 0.0 * x[c];
  for (int c = 0; c < kSpins<Dim>; ++c) zero += 0.0 * u[c];
  return std::sqrt(v2) * dt + zero;
}

template <int Dim>
double farthest_travel(const ParticleStore<Dim>& store, double dt, Rows rows) {
  double most = 0.0;
  for (std::int32_t i = rows.begin; i < rows.end; ++i) {
    const double travel = step_travel(store, dt, i);
    if (!(travel <= most))
      most = std::isnan(travel) ? std::numeric_limits<double>::infinity() : travel;
  }
  return most;
}

template <int Dim>
Suspect suspect_of(const ParticleStore<Dim>& store, std::int32_t row) {
  Suspect s;
  s.id = store.id[static_cast<std::size_t>(row)];
  std::copy_n(store.x(row), Dim, s.position);
  std::copy_n(store.v(row), Dim, s.velocity);
  s.radius = store.radius(row);
  double v2 = 0.0;
  for (int c = 0; c < Dim; ++c) v2 += store.v(row)[c] * store.v(row)[c] + 0.0 * store.x(row)[c];
  s.speed2 = std::isfinite(v2) ? v2 : std::numeric_limits<double>::max();
  return s;
}

template <int Dim>
double PassageWatch<Dim>::stiffness(std::uint8_t code, const Overlap& overlap) const {
  constexpr double kNoHistory[kMostHistory] = {};
  return 2.0 *
         world_.laws.law().template in<Dim>().energy(world_.laws.row(code), overlap, kNoHistory) /
         (overlap.depth * overlap.depth);
}

template <int Dim>
void PassageWatch<Dim>::look_at(const PairList& pairs) const {
  const double dt = world_.last_dt;
  const PeriodicBox& box = world_.grid.box();
  for (std::size_t k = 0; k < pairs.i.size(); ++k) {
    const std::int32_t i = pairs.i[k], j = pairs.j[k];
    const double *v = store_.v(i), *w = store_.v(j);
    double s[Dim], s2 = 0.0;
    for (int c = 0; c < Dim; ++c) s[c] = dt * (w[c] - v[c]), s2 += s[c] * s[c];
    const double least_radius = std::min(store_.radius(i), store_.radius(j));
    if (s2 <= least_radius * least_radius || pairs.code[k] == LawTable::kBonded) continue;
    if (i == store_.waste()) break;  // padding
    double d[Dim];
    for (int c = 0; c < Dim; ++c) {
      d[c] = box.nearest(store_.x(j)[c] - store_.x(i)[c], c);
    }
    const double reach = store_.radius(i) + store_.radius(j);
    const Course course = course_of<Dim>(d, s, reach);
    if (!course.skips_approach() && course.nearest >= reach - least_radius) continue;
    Passage p;
    p.first = suspect_of(store_, i);
    p.second = suspect_of(store_, j);
    if (p.second.id < p.first.id) std::swap(p.first, p.second);
    p.travel = std::sqrt(s2);
    p.mass = 1.0 / (store_.inverse_mass(i) + store_.inverse_mass(j));
    p.stiffness = stiffness(
        pairs.code[k], {least_radius, store_.inverse_radius(i) + store_.inverse_radius(j), reach});
    found_.add(p);
  }
}

template <int Dim>
void PassageWatch<Dim>::look_at(std::span<const WallContact<Dim>> contacts, Rows rows) const {
  auto it =
      std::lower_bound(contacts.begin(), contacts.end(), rows.begin,
                       [](const WallContact<Dim>& c, std::int32_t row) { return c.row < row; });
  for (; it != contacts.end() && it->row < rows.end; ++it) {
    const auto w = static_cast<std::size_t>(it->wall);
    if (world_.wall_specs[w].kind != WallKind::Plate) continue;
    const double *x = store_.x(it->row), *v = store_.v(it->row), radius = store_.radius(it->row);
    double s[3] = {}, s2 = 0.0;
    for (int c = 0; c < Dim; ++c) {
      s[c] = world_.last_dt * (v[c] - world_.walls[w].velocity[c]);
      s2 += s[c] * s[c];
    }
    const auto foot = [&](double back) {
      double at[3] = {};
      for (int c = 0; c < Dim; ++c) at[c] = x[c] - back * s[c];
      return world_.wall_shapes[w].foot(world_.walls[w].point, it->image, at);
    };
    const auto distance = [&](double back) { return foot(back).distance; };
    const double end = distance(0.0);
    if (s2 <= end * end && s2 <= radius * radius) continue;
    const Course course{distance(1.0), least(distance), end, radius};
    const bool goes_through = course.nearest < 1e-6 * radius;
    const auto is_passed = [&] { return course.skips_approach() || turns(foot, course); };
    if (!goes_through && (s2 <= radius * radius || !is_passed())) continue;
    Passage p;
    p.first = suspect_of(store_, it->row);
    p.wall = it->wall;
    p.travel = std::sqrt(s2);
    const WallSpec& spec = world_.wall_specs[w];
    p.mass = 1.0 / (store_.inverse_mass(it->row) + (spec.is_loaded ? 1.0 / spec.mass : 0.0));
    p.stiffness =
        stiffness(world_.laws.code(spec.material, store_.type[static_cast<std::size_t>(it->row)]),
                  {radius, store_.inverse_radius(it->row), radius});
    found_.add(p);
  }
}

template double step_travel(const ParticleStore<2>&, double, std::int32_t);
template double step_travel(const ParticleStore<3>&, double, std::int32_t);
template double farthest_travel(const ParticleStore<2>&, double, Rows);
template double farthest_travel(const ParticleStore<3>&, double, Rows);
template Suspect suspect_of(const ParticleStore<2>&, std::int32_t);
template Suspect suspect_of(const ParticleStore<3>&, std::int32_t);
template class PassageWatch<2>;
template class PassageWatch<3>;

}  // namespace barchan
