// How bonds limit the time step.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <vector>

#include <Eigen/Eigenvalues>

#include <barchan/core/generators/close_pairs.hpp>
#include <barchan/core/links/bonds.hpp>
#include <barchan/tasks/step_limits.hpp>

namespace barchan {
namespace {

/// Stiffness and damping of one particle in its bonds, per mass [1/s², 1/s]: partners move against
/// it.
struct Bonded {
  Eigen::Matrix3d k = Eigen::Matrix3d::Zero(), c = Eigen::Matrix3d::Zero();
  double shear_k = 0.0, shear_c = 0.0, bend_k = 0.0, bend_c = 0.0;

  struct Spring {
    double k, c;
  };
  void add_linear(const Vec3& normal, const Spring& along, const Spring& across, int dimension) {
    const Eigen::Matrix3d on = normal * normal.transpose();
    Eigen::Matrix3d off = Eigen::Matrix3d::Identity() - on;
    if (dimension == 2) off(2, 2) = 0.0;
    k += along.k * on + across.k * off;
    c += along.c * on + across.c * off;
  }
  [[nodiscard]] static double largest(const Eigen::Matrix3d& matrix) {
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix, Eigen::EigenvaluesOnly)
        .eigenvalues()[2];
  }
};

BondSection section_of(const Model& model, const BondLaw& law, double length, double r_a,
                       double r_b) {
  return model.dimension == 2 ? bond_section<2>(law, length, r_a, r_b)
                              : bond_section<3>(law, length, r_a, r_b);
}

struct BondEnd {
  const ParticleData& particle;
  Bonded& bonds;
};
void add_bond(const Model& model, const BondData& bond, const BondEnd& end_a,
              const BondEnd& end_b) {
  const ParticleData &a = end_a.particle, &b = end_b.particle;
  const BondLaw& law = model.bond_laws[static_cast<std::size_t>(bond.law)];
  const PairSpace space{model.dimension, model.domain.lo, model.domain.hi, model.domain.periodic};
  const Vec3 d = space.difference(b.position, a.position);
  const double length = d.norm();
  const double inverse =
      1.0 / mass_in_motion(a, model.dimension) + 1.0 / mass_in_motion(b, model.dimension);
  if (!(length > 0.0) || !(inverse > 0.0)) return;
  const double unstressed = bond.length > 0.0 ? bond.length : length;
  const BondSection s = section_of(model, law, unstressed, a.radius, b.radius);
  const double gain = spin_gain(model.dimension);
  const double turning = gain * (1.0 / (mass_in_motion(a, model.dimension) * a.radius * a.radius) +
                                 1.0 / (mass_in_motion(b, model.dimension) * b.radius * b.radius));
  const double shear = (1.0 + gain) * inverse;
  const double bending = std::max(s.bending, model.dimension == 3 ? s.twisting : 0.0);
  const auto dashpot = [&](double k, double inverse_m) {
    return 2.0 * law.damping_ratio * std::sqrt(k / inverse_m) * inverse_m;
  };
  const double ks_share =
      std::sqrt(inverse / shear);  // the shear dashpot is critical for the mass without rotation
  for (Bonded* p : {&end_a.bonds, &end_b.bonds}) {
    p->add_linear(d / length, {s.kn * inverse, dashpot(s.kn, inverse)},
                  {s.ks * inverse, dashpot(s.ks, inverse)}, model.dimension);
    p->shear_k += s.ks * shear;
    p->shear_c += dashpot(s.ks, shear) / ks_share;
    p->bend_k += bending * turning;
    p->bend_c += dashpot(bending, turning);
  }
}

}  // namespace

void add_bonds(const Model& model, const ParticleSet& set, Limits& limits) {
  if (set.bonds.empty()) return;
  std::vector<std::size_t> by_id(set.particles.size());
  std::iota(by_id.begin(), by_id.end(), std::size_t{0});
  const auto id_of = [&](std::size_t i) { return set.particles[i].id; };
  std::sort(by_id.begin(), by_id.end(),
            [&](std::size_t a, std::size_t b) { return id_of(a) < id_of(b); });
  const auto find = [&](std::int64_t id) {
    return *std::lower_bound(by_id.begin(), by_id.end(), id,
                             [&](std::size_t i, std::int64_t wanted) { return id_of(i) < wanted; });
  };
  std::map<std::size_t, Bonded> bonded;
  for (const BondData& bond : set.bonds) {
    const std::size_t a = find(bond.id_a), b = find(bond.id_b);
    add_bond(model, bond, {set.particles[a], bonded[a]}, {set.particles[b], bonded[b]});
  }
  const auto add = [&](const Bonded& p, const std::string& law) {
    limits.add("bond " + law + ", stretching",
               stable_step(1.0, Bonded::largest(p.k), Bonded::largest(p.c)));
    limits.add("bond " + law + ", shearing", stable_step(1.0, p.shear_k, p.shear_c));
    limits.add("bond " + law + ", bending", stable_step(1.0, p.bend_k, p.bend_c));
  };
  for (const BondData& bond : set.bonds) {
    const std::string& law = model.bond_laws[static_cast<std::size_t>(bond.law)].name;
    for (const std::int64_t id : {bond.id_a, bond.id_b}) {
      const std::size_t i = find(id);
      if (!set.particles[i].fixed) add(bonded.at(i), law);
    }
  }
}

}  // namespace barchan
