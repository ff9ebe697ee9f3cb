#include <algorithm>
#include <cmath>
#include <limits>

#include <barchan/core/particles/row_particle.hpp>
#include <barchan/tasks/engine.hpp>

// What callers see of a simulation between steps.

namespace barchan {

template <int Dim>
OwnedParticle Simulation::EngineOf<Dim>::particle(const ParticleStore<Dim>& store,
                                                  std::int32_t i) const {
  const double im = store.inverse_mass(i);
  return {particle_at(store, i), im > 0.0 ? 1.0 / im : std::numeric_limits<double>::infinity()};
}

template <int Dim>
void Simulation::EngineOf<Dim>::for_each_owned(
    const std::function<void(const OwnedParticle&)>& visit) const {
  for (int l = 0; l < strip_->num_lanes(); ++l) {
    const auto& store = strip_->lane(l).store();
    for (std::int32_t i = 0; i < store.num_owned; ++i) visit(particle(store, i));
  }
}

template <int Dim>
void Simulation::EngineOf<Dim>::for_each_bond(const BondVisitor& visit) {
  strip_->complete_halo();
  const PeriodicBox& box = world_.grid.box();
  for (int l = 0; l < strip_->num_lanes(); ++l) {
    const Lane<Dim>& lane = strip_->lane(l);
    const BondSet<Dim>& bonds = lane.bonds();
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(bonds.bonds().size()); ++i) {
      if (!lane.counts_bond(i)) continue;
      const double *a = lane.store().x(bonds.end_a(i)), *b = lane.store().x(bonds.end_b(i));
      Vec3 first = Vec3::Zero(), second = Vec3::Zero();
      for (int c = 0; c < Dim; ++c) {
        const double d = b[c] - a[c];
        first[c] = a[c];
        second[c] = a[c] + (d - box.length[c] * std::rint(d * box.inverse[c]));
      }
      visit(data_of(bonds.bonds()[static_cast<std::size_t>(i)]), first, second);
    }
  }
}

template <int Dim>
void Simulation::EngineOf<Dim>::apply_forces(
    const std::function<Vec3(const OwnedParticle&)>& force) {
  for (int l = 0; l < strip_->num_lanes(); ++l) {
    auto& store = strip_->lane(l).store();
    store.external.assign(static_cast<std::size_t>(store.num_owned) * Layout<Dim>::kForce, 0.0);
    for (std::int32_t i = 0; i < store.num_owned; ++i) {
      const Vec3 f = force(particle(store, i));
      for (int c = 0; c < Dim; ++c)
        store.external[static_cast<std::size_t>(i) * Layout<Dim>::kForce +
                       static_cast<std::size_t>(c)] = f[c];
    }
  }
}

template <int Dim>
void Simulation::EngineOf<Dim>::clear_forces() {
  for (int l = 0; l < strip_->num_lanes(); ++l) strip_->lane(l).store().external.clear();
}

template <int Dim>
Measures Simulation::EngineOf<Dim>::measure() {
  strip_->complete_halo();
  Measures mine;
  std::vector<WallSums> walls(world_.walls.size());
  for (int l = 0; l < strip_->num_lanes(); ++l) {
    mine.add(strip_->lane(l).measure(model_.gravity));
    const auto sums = strip_->lane(l).measure_walls();
    for (std::size_t w = 0; w < sums.size(); ++w) walls[w].add(sums[w]);
  }
  std::vector<ExactSum*> exact{&mine.kinetic, &mine.elastic, &mine.gravitational};
  for (ExactSum& p : mine.momentum) exact.push_back(&p);
  for (WallSums& w : walls) {
    for (int c = 0; c < 3; ++c) {
      exact.push_back(&w.force[c]);
      exact.push_back(&w.torque[c]);
    }
    exact.push_back(&w.work);
  }
  std::vector<std::int64_t> digits{mine.contacts, mine.bonds, mine.broken_bonds};
  for (const ExactSum* sum : exact)
    digits.insert(digits.end(), sum->digits().begin(), sum->digits().end());
  communicator_.allreduce_sum(std::span<std::int64_t>(digits));
  auto from = digits.begin();
  mine.contacts = *from++;
  mine.bonds = *from++;
  mine.broken_bonds = *from++;
  for (ExactSum* sum : exact) {
    std::copy_n(from, ExactSum::kDigits, sum->digits().begin());
    from += ExactSum::kDigits;
  }
  double maxima[4] = {mine.max_overlap, mine.max_speed, mine.max_overlap_share,
                      mine.max_inverse_mass};
  communicator_.allreduce_max(std::span<double>(maxima));
  mine.max_overlap = maxima[0];
  mine.max_speed = maxima[1];
  mine.max_overlap_share = maxima[2];
  mine.max_inverse_mass = maxima[3];
  overlap_ = std::max(overlap_, mine.max_overlap_share);
  for (std::size_t w = 0; w < walls.size(); ++w) {
    for (int c = 0; c < 3; ++c) {
      world_.walls[w].force[c] = walls[w].force[c].value();
      world_.walls[w].torque[c] = walls[w].torque[c].value();
    }
    world_.walls[w].work = walls[w].work.value();
  }
  return mine;
}

template <int Dim>
std::uint64_t Simulation::EngineOf<Dim>::digest() {
  std::uint64_t sum = 0;
  for (int l = 0; l < strip_->num_lanes(); ++l) sum += strip_->lane(l).digest();
  communicator_.allreduce_sum(std::span(&sum, 1));
  return sum;
}

template <int Dim>
Timings Simulation::EngineOf<Dim>::timings() const {
  Timings t;
  const StepTimes steps = graph_->times();
  t.loop_seconds = loop_seconds_;
  t.steps = loop_steps_;
  // Lanes work side by side: a step's search is averaged over them, a rebuild's counts once.
  SearchSeconds search;
  const double share = 1.0 / strip_->num_lanes();
  for (int l = 0; l < strip_->num_lanes(); ++l) {
    const SearchSeconds& lane = strip_->lane(l).search_seconds();
    search.rebuild = std::max(search.rebuild, lane.rebuild);
    search.chunks += share * lane.chunks;
    search.bands += share * lane.bands;
  }
  const bool is_alone = communicator_.size() == 1;
  const RebuildWaits waits = is_alone ? RebuildWaits{} : strip_->rebuild_waits();
  const double reductions = is_alone ? 0.0 : schedule_->wait_seconds() + plates_->wait_seconds();
  t.phases = {{"forces", steps.chunks - search.chunks},
              {"bands", steps.bands - search.bands},
              {"send", steps.send},
              {"poll", steps.poll},
              {"wait", steps.wait},
              {"rebuild", rebuild_seconds_ - search.rebuild - waits.sum()},
              {"rebuild_wait", waits.sum()},
              {"reduction_wait", reductions},
              {"search", search.chunks + search.bands + search.rebuild}};
  if (checkpoint_seconds_ > 0.0) t.phases["checkpoint"] = checkpoint_seconds_;
  double rest = loop_seconds_;
  for (const auto& [name, seconds] : t.phases) rest -= seconds;
  // Within steps: tasks that start, and workers that wait for each other.
  const double tasks =
      steps.run - steps.chunks - steps.bands - steps.send - steps.poll - steps.wait;
  t.phases["tasks"] = std::clamp(tasks, 0.0, std::max(0.0, rest));
  t.phases["between_steps"] = std::max(0.0, rest - t.phases["tasks"]);
  if (strip_->exchange() != nullptr) t.exchange = strip_->exchange()->stats();
  t.communication = {{"halo", {steps.in_flight, steps.exposed(), steps.late}},
                     {"rebuild", {waits.in_flight + waits.halo, waits.sum(), waits.late}},
                     {"reductions", {reductions, reductions}}};
  for (const auto& [name, kind] : t.communication) {
    t.in_flight_seconds += std::max(kind.in_flight, kind.exposed);
    t.exposed_seconds += kind.exposed;
  }
  t.rebuilds = strip_->num_rebuilds();
  t.migrations = strip_->num_migrations();
  return t;
}

template class Simulation::EngineOf<2>;
template class Simulation::EngineOf<3>;

}  // namespace barchan
