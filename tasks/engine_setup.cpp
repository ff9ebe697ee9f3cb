#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <barchan/comm/strips.hpp>
#include <barchan/core/error.hpp>
#include <barchan/core/generators/make_particles.hpp>
#include <barchan/tasks/engine.hpp>
#include <barchan/tasks/stability.hpp>
#include <barchan/tasks/threads.hpp>

namespace barchan {
namespace {

constexpr int kMinSlabs = 2;

double longest_bond(const ParticleSet& set) {
  if (set.bonds.empty()) return 0.0;
  std::vector<std::pair<std::int64_t, const ParticleData*>> by_id;
  for (const ParticleData& p : set.particles) by_id.emplace_back(p.id, &p);
  std::sort(by_id.begin(), by_id.end());
  const auto find = [&](std::int64_t id) {
    return std::lower_bound(by_id.begin(), by_id.end(), id, [](const auto& entry, std::int64_t i) { return entry.first < i; })->second;
  };
  double longest = 0.0;
  for (const BondData& b : set.bonds) {
    longest = std::max(longest, find(b.id_a)->radius + find(b.id_b)->radius);
  }
  return longest;
}

}  // namespace

template <int Dim>
Simulation::EngineOf<Dim>::EngineOf(const Model& model, const ParticleSet& particles, MPI_Comm comm, const RunOptions& options)
    : Engine(model, comm, options) {
  num_particles_ = static_cast<std::int64_t>(particles.particles.size());
  if (options_.threads <= 0) options_.threads = default_threads(communicator_);
  make_world(particles);
  make_strip(particles);
  graph_ = std::make_unique<StepGraph<Dim>>(*strip_, options_.threads, options_.schedule, options_.max_delay_seconds, options_.delay_seed);
  schedule_ = std::make_unique<RebuildSchedule>(communicator_, world_.skin, world_.dt, model.gravity.norm());
  plates_ = std::make_unique<Plates>(communicator_, world_.wall_specs, world_.dt);
}

template <int Dim>
void Simulation::EngineOf<Dim>::make_world(const ParticleSet& set) {
  check_particles(model_, set);
  double largest = 0.0;
  for (const ParticleData& p : set.particles) largest = std::max(largest, p.radius);
  world_.skin = model_.search.skin.value_or(default_skin(set));
  world_.dt = model_.time.step;
  world_.search = options_.search.value_or(model_.search.kind);
  world_.num_particles = num_particles_;
  // A bond may stretch by a tenth before it outgrows the halo.
  const double cutoff = std::max(2.0 * largest, 1.1 * longest_bond(set)) + world_.skin;
  world_.grid = Grid<Dim>(model_.domain, cutoff, num_particles_);
  world_.laws = LawTable(model_.contacts);
  world_.kernels = make_kernels(Dim, barchan::vector_width(options_.vector), world_.laws, !set.bonds.empty(), world_.grid.box());
  world_.bond_laws = model_.bond_laws;
  world_.wall_specs = model_.walls;
  for (const WallSpec& spec : model_.walls) {
    WallState state;
    state.point = spec.point;
    state.velocity = spec.velocity;
    state.is_active = spec.from_stage <= 0;
    world_.walls.push_back(state);
    walls_at_rebuild_.push_back(spec.point);
  }
}

template <int Dim>
void Simulation::EngineOf<Dim>::make_strip(const ParticleSet& set) {
  const int fit = max_strips(world_.grid.num_slabs(), kMinSlabs);
  if (communicator_.size() > std::max(1, fit)) {
    throw InputError(fmt::format("{} ranks for a domain that is {} cells of {:.3g} m long", communicator_.size(), world_.grid.num_slabs(),
                                 (model_.domain.hi - model_.domain.lo)[world_.grid.axis(0)] / world_.grid.num_slabs()),
                     fmt::format("at most {} strips of {} cells fit: use at most {} ranks, or cut along a longer axis by domain.strip_axis",
                                 std::max(1, fit), kMinSlabs, std::max(1, fit)));
  }
  const int lanes = std::clamp(options_.threads, 1, std::max(1, fit / communicator_.size()));
  std::unique_ptr<Exchange> exchange;
  const bool returns = options_.exchange == "return";
  const auto names = exchange_choices();
  if (std::find(names.begin(), names.end(), options_.exchange) == names.end()) {
    std::string known;
    for (const auto& name : names) known += (known.empty() ? "" : ", ") + name;
    throw InputError("unknown exchange '" + options_.exchange + "'", "there are: " + known);
  }
  if (communicator_.size() > 1) {
    ExchangeOptions exchange_options;
    exchange_options.max_delay_seconds = options_.max_delay_seconds;
    exchange_options.delay_seed = options_.delay_seed;
    exchange = make_exchange(returns ? "sendrecv" : options_.exchange, communicator_,
                             strip_neighbours(communicator_.rank(), communicator_.size(), world_.grid.is_periodic(0)), exchange_options);
  }
  strip_ = std::make_unique<Strip<Dim>>(world_, communicator_, std::move(exchange), lanes, returns);
  strip_->seed(set);
}

template class Simulation::EngineOf<2>;
template class Simulation::EngineOf<3>;

}  // namespace barchan
