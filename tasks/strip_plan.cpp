#include <barchan/tasks/strip_plan.hpp>

#include <algorithm>
#include <unordered_map>

#include <barchan/comm/topology/strips.hpp>
#include <barchan/core/generators/close_pairs.hpp>
#include <barchan/core/model/contact_range.hpp>
#include <barchan/tasks/cuts.hpp>
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
CutPlan plan_for(const Model& model, const ParticleSet& set) {
  const double reach =
      search_reach(model, set, model.search.skin.value_or(default_skin(model, set)));
  const auto num_particles = static_cast<std::int64_t>(set.particles.size());
  const Grid<Dim> grid(model.domain, reach);
  CutPlan plan{room_of(grid, num_particles), {}, {}};
  for (int axis = 0; axis < Dim; ++axis)
    plan.cell[static_cast<std::size_t>(axis)] =
        (model.domain.hi - model.domain.lo)[grid.axis(axis)] / grid.cells(axis);
  plan.cells.reserve(set.particles.size());
  for (const CellAt<Dim>& cell : cells_of(grid, set)) {
    auto& at = plan.cells.emplace_back();
    std::copy(cell.begin(), cell.end(), at.begin());
  }
  for (std::size_t k = 0; k < Dim && !plan.cells.empty(); ++k) {
    const auto [lo, hi] = std::minmax_element(plan.cells.begin(), plan.cells.end(),
                                              [k](auto& a, auto& b) { return a[k] < b[k]; });
    plan.room.filled[k] = (*hi)[k] - (*lo)[k] + 1;
  }
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
std::vector<CellAt<Dim>> cells_of(const Grid<Dim>& grid, const ParticleSet& set) {
  std::vector<CellAt<Dim>> cells;
  cells.reserve(set.particles.size());
  for (const ParticleData& particle : set.particles) {
    double x[3] = {particle.position[0], particle.position[1], particle.position[2]};
    grid.wrap(x);
    cells.push_back(grid.cell(x));
  }
  return cells;
}

template std::vector<CellAt<2>> cells_of<2>(const Grid<2>&, const ParticleSet&);
template std::vector<CellAt<3>> cells_of<3>(const Grid<3>&, const ParticleSet&);

std::vector<std::int64_t> CutPlan::rank_counts(const CutShape& shape) const {
  CellLoads sums(room.cells);
  for (const auto& at : cells) sums.add<3>(at);
  const Cuts cuts = equal_cuts(sums, {shape.form, shape.ranks, {1, 1, 1}});
  std::vector<std::int64_t> counts(static_cast<std::size_t>(shape.num_ranks()), 0);
  for (const auto& at : cells) {
    int rank = 0;
    for (std::size_t k = 0; k < 3; ++k) rank = rank * shape.ranks[k] + strip_of(cuts[k], at[k]);
    ++counts[static_cast<std::size_t>(rank)];
  }
  return counts;
}

CutPlan plan_cuts(const Model& model, const ParticleSet& particles) {
  return model.dimension == 2 ? plan_for<2>(model, particles) : plan_for<3>(model, particles);
}

}  // namespace barchan
