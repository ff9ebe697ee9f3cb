#include <barchan/core/brick/energy_works.hpp>

#include <algorithm>

#include <barchan/core/base/vec.hpp>

namespace barchan {
namespace {

/// Calls f(c) for the components of a force record: forces, then torques / r.
template <int Dim, class F>
void for_each_component(F&& f) {
  using L = Layout<Dim>;
  for (int c = 0; c < Dim; ++c) f(c);
  for (int c = 0; c < kSpins<Dim>; ++c) f(L::kTorque + c);
}

/// What a component of a force record does work with: velocities, and surface velocities.
template <int Dim>
void speeds_of(const ParticleStore<Dim>& store, std::int32_t row, double* to) {
  std::copy_n(store.v(row), Dim, to);
  std::copy_n(store.u(row), kSpins<Dim>, to + Layout<Dim>::kTorque);
}

}  // namespace

void EnergyWorks::begin(const ExactSum& kinetic, const ExactSum& elastic,
                        const ExactSum& bonds_elastic, const ExactSum& walls) {
  *this = {};
  (*this)[StartKinetic] = kinetic;
  (*this)[StartContacts] = elastic;
  for (std::size_t d = 0; d < ExactSum::kDigits; ++d)
    (*this)[StartContacts].digits()[d] -= bonds_elastic.digits()[d];
  (*this)[StartBonds] = bonds_elastic;
  (*this)[StartWalls] = walls;
  (*this)[Begun].add(1.0);
}

template <int Dim>
double kinetic_energy(const ParticleStore<Dim>& store, std::int32_t row) {
  const double im = store.inverse_mass(row);
  if (im == 0.0) return 0.0;
  double v2 = 0.0, u2 = 0.0;
  for (int c = 0; c < Dim; ++c) v2 += store.v(row)[c] * store.v(row)[c];
  for (int c = 0; c < kSpins<Dim>; ++c) u2 += store.u(row)[c] * store.u(row)[c];
  return 0.5 / im * (v2 + u2 / Layout<Dim>::kSpinGain);
}

template <int Dim>
void WorkAccount<Dim>::begin(const ParticleStore<Dim>& store, Rows rows, double rounder) {
  rows_ = rows;
  const std::size_t n = static_cast<std::size_t>(rows.size()) * kForce;
  speeds_.assign(n, 0.0);
  extra_.assign(n, 0.0);
  for (auto& part : forces_) part.assign(n, 0.0);
  for (std::int32_t i = rows.begin; i < rows.end; ++i) {
    const std::size_t at = static_cast<std::size_t>(i - rows.begin) * kForce;
    speeds_of(store, i, speeds_.data() + at);
    const double* f = store.force.data() + static_cast<std::size_t>(i) * kForce;
    for_each_component<Dim>(
        [&](int c) { forces_[0][at + static_cast<std::size_t>(c)] = f[c] - rounder; });
  }
}

template <int Dim>
void WorkAccount<Dim>::book(const ParticleStore<Dim>& store, EnergyWorks::Part part) {
  const auto which =
      static_cast<std::size_t>(std::find(kForces.begin(), kForces.end(), part) - kForces.begin());
  for (std::size_t k = 0; k < extra_.size(); ++k) {
    forces_[which][k] += store.extra[k] - extra_[k];
    extra_[k] = store.extra[k];
  }
}

template <int Dim>
void WorkAccount<Dim>::end(const ParticleStore<Dim>& store, double kick,
                           std::span<const double, 3> gravity, bool is_damped, EnergyWorks& works) {
  double after[kForce] = {};
  for (std::int32_t i = rows_.begin; i < rows_.end; ++i) {
    const double im = store.inverse_mass(i);
    if (im == 0.0) continue;
    const std::size_t at = static_cast<std::size_t>(i - rows_.begin) * kForce;
    speeds_of(store, i, after);
    double sums[kForces.size()] = {}, falling = 0.0, gained = 0.0;
    for_each_component<Dim>([&](int c) {
      const double before = speeds_[at + static_cast<std::size_t>(c)];
      const double way = 0.5 * kick * (before + after[c]);  // [m]
      for (std::size_t p = 0; p < kForces.size(); ++p)
        sums[p] += forces_[p][at + static_cast<std::size_t>(c)] * way;
      const double gain = c < Dim ? 1.0 : Layout<Dim>::kSpinGain;
      gained += 0.5 / (im * gain) * (after[c] - before) * (after[c] + before);
      if (c < Dim) falling += gravity[static_cast<std::size_t>(c)] * way / im;
    });
    for (std::size_t p = 0; p < kForces.size(); ++p) {
      works[kForces[p]].add(sums[p]);
      gained -= sums[p];
    }
    works[EnergyWorks::Gravity].add(falling);
    if (is_damped) works[EnergyWorks::LocalDamping].add(gained - falling);
  }
}

template double kinetic_energy(const ParticleStore<2>&, std::int32_t);
template double kinetic_energy(const ParticleStore<3>&, std::int32_t);
template class WorkAccount<2>;
template class WorkAccount<3>;

}  // namespace barchan
