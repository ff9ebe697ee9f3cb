#include <barchan/tasks/strip_plan.hpp>

#include <algorithm>
#include <numeric>
#include <unordered_map>

#include <fmt/format.h>

#include <barchan/comm/topology/strips.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/core/generators/close_pairs.hpp>
#include <barchan/core/model/contact_range.hpp>
#include <barchan/tasks/forecast.hpp>

namespace barchan {
namespace {

constexpr double kBondStretch = 1.1;
constexpr double kAboutTouching = 1.01;

/// Of a bond between particles that about touch, the sum of their radii; its stretch covers the
/// rest.
double longest_bond(const Model& model, const ParticleSet& set) {
  if (set.bonds.empty()) return 0.0;
  const PairSpace space{model.dimension, model.domain.lo, model.domain.hi, model.domain.periodic};
  std::unordered_map<std::int64_t, const ParticleData*> by_id;
  for (const ParticleData& p : set.particles) by_id[p.id] = &p;
  double longest = 0.0;
  for (const BondData& bond : set.bonds) {
    const ParticleData &a = *by_id.at(bond.id_a), &b = *by_id.at(bond.id_b);
    const double touching = a.radius + b.radius;
    const double apart = std::max(space.difference(a.position, b.position).norm(), bond.length);
    longest = std::max(longest, apart <= kAboutTouching * touching ? touching : apart);
  }
  return longest;
}

template <int Dim>
StripPlan plan_for(const Model& model, const ParticleSet& set) {
  const double reach =
      search_reach(model, set, model.search.skin.value_or(default_skin(model, set)));
  const Grid<Dim> grid(model.domain, reach, static_cast<std::int64_t>(set.particles.size()));
  StripPlan plan;
  plan.axis = grid.axis(0);
  plan.slab_width = (model.domain.hi - model.domain.lo)[plan.axis] / grid.num_slabs();
  plan.slab_counts = count_slabs(slabs_of(grid, set), grid.num_slabs());
  return plan;
}

}  // namespace

double search_reach(const Model& model, const ParticleSet& particles, double skin) {
  double largest = 0.0;
  for (const ParticleData& p : particles.particles) largest = std::max(largest, p.radius);
  return std::max(2.0 * largest + contact_range(model.contacts, largest),
                  kBondStretch * longest_bond(model, particles)) +
         skin;
}

template <int Dim>
std::vector<int> slabs_of(const Grid<Dim>& grid, const ParticleSet& set) {
  std::vector<int> slabs;
  slabs.reserve(set.particles.size());
  for (const ParticleData& particle : set.particles) {
    double x[3] = {particle.position[0], particle.position[1], particle.position[2]};
    grid.wrap(x);
    slabs.push_back(grid.coordinate(x, 0));
  }
  return slabs;
}

template std::vector<int> slabs_of(const Grid<2>&, const ParticleSet&);
template std::vector<int> slabs_of(const Grid<3>&, const ParticleSet&);

std::vector<std::int64_t> count_slabs(std::span<const int> slabs, int num_slabs) {
  std::vector<std::int64_t> counts(static_cast<std::size_t>(num_slabs), 0);
  for (const int slab : slabs) ++counts[static_cast<std::size_t>(slab)];
  return counts;
}

int StripPlan::most_ranks() const {
  return max_strips(static_cast<int>(slab_counts.size()), kMinSlabs);
}

std::vector<std::int64_t> StripPlan::strip_counts(int num_strips) const {
  const std::vector<int> cuts = cut_equal(slab_counts, num_strips, kMinSlabs);
  std::vector<std::int64_t> counts;
  for (std::size_t s = 0; s + 1 < cuts.size(); ++s) {
    counts.push_back(std::accumulate(slab_counts.begin() + cuts[s],
                                     slab_counts.begin() + cuts[s + 1], std::int64_t{0}));
  }
  return counts;
}

StripPlan plan_strips(const Model& model, const ParticleSet& particles) {
  return model.dimension == 2 ? plan_for<2>(model, particles) : plan_for<3>(model, particles);
}

void check_ranks(int num_ranks, const Model& model, int num_slabs) {
  const int fit = max_strips(num_slabs, kMinSlabs);
  if (num_ranks <= fit) return;
  const int axis = model.domain.strip_axis;
  const double width = (model.domain.hi - model.domain.lo)[axis] / num_slabs;
  throw InputError(model.domain.place,
                   fmt::format("{} ranks for a domain that is {} cells of {:.3g} m long along {}",
                               num_ranks, num_slabs, width, "xyz"[axis]),
                   fmt::format("at most {} strip{} of {} cells fit: use at most {} rank{}, or "
                               "cut along a longer axis by domain.strip_axis",
                               fit, fit == 1 ? "" : "s", kMinSlabs, fit, fit == 1 ? "" : "s"));
}

}  // namespace barchan
