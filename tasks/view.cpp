#include <barchan/tasks/view.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <barchan/core/base/clock.hpp>
#include <barchan/core/brick/measure.hpp>
#include <barchan/core/particles/row_particle.hpp>

namespace barchan {
namespace {

template <int Dim>
OwnedParticle particle(const ParticleStore<Dim>& store, std::int32_t i) {
  const double im = store.inverse_mass(i);
  return {particle_at(store, i), im > 0.0 ? 1.0 / im : std::numeric_limits<double>::infinity()};
}

/// Sums and largest values over all ranks, exact whatever their order. Collective.
template <int Dim>
void reduce(const Communicator& communicator, const World<Dim>& world, Measures& m,
            std::vector<WallSums>& walls) {
  std::vector<ExactSum*> sums{&m.kinetic, &m.elastic, &m.gravitational, &m.bonds_elastic};
  if (world.heat.is_on) {
    sums.insert(sums.end(), {&m.heat, &m.heat_capacity});
    for (WallSums& w : walls) sums.push_back(&w.heat_flow);
  }
  if (world.accounts) {
    for (ExactSum& work : m.works.sums) sums.push_back(&work);
    sums.insert(sums.end(), {&m.sliding_elastic, &m.rolling_elastic});
  }
  for (ExactSum& p : m.momentum) sums.push_back(&p);
  for (WallSums& w : walls) {
    for (ExactSum& f : w.force) sums.push_back(&f);
    for (ExactSum& t : w.torque) sums.push_back(&t);
    sums.push_back(&w.work);
  }
  std::vector<std::int64_t> digits{m.contacts, m.bonds, m.broken_bonds};
  for (const ExactSum* sum : sums)
    digits.insert(digits.end(), sum->digits().begin(), sum->digits().end());
  communicator.allreduce_sum(std::span<std::int64_t>(digits));
  auto from = digits.begin();
  for (std::int64_t* count : {&m.contacts, &m.bonds, &m.broken_bonds}) *count = *from++;
  for (ExactSum* sum : sums) {
    std::copy_n(from, ExactSum::kDigits, sum->digits().begin());
    from += ExactSum::kDigits;
  }
  double* const largest[] = {&m.max_overlap, &m.max_speed, &m.max_overlap_share,
                             &m.max_inverse_mass};
  std::vector<double> maxima;
  for (const double* value : largest) maxima.push_back(*value);
  maxima.insert(maxima.end(), {m.max_temperature, -m.min_temperature});
  communicator.allreduce_max(std::span<double>(maxima));
  for (std::size_t k = 0; k < std::size(largest); ++k) *largest[k] = maxima[k];
  m.max_temperature = maxima[std::size(largest)];
  m.min_temperature = -maxima.back();
}

/// Lanes work side by side: a step's search is averaged over them, a rebuild's counts once.
template <int Dim>
SearchSeconds search_of(const Strip<Dim>& strip) {
  SearchSeconds search;
  const double share = 1.0 / strip.num_lanes();
  for (const Lane<Dim>& lane : strip.lanes()) {
    const SearchSeconds& seconds = lane.lists.seconds();
    search.rebuild = std::max(search.rebuild, seconds.rebuild);
    search.chunks += share * seconds.chunks;
    search.bands += share * seconds.bands;
  }
  return search;
}

}  // namespace

template <int Dim>
void for_each_owned(const Strip<Dim>& strip,
                    const std::function<void(const OwnedParticle&)>& visit) {
  for (const Lane<Dim>& lane : strip.lanes()) {
    for (std::int32_t i = 0; i < lane.brick.store.num_owned; ++i)
      visit(particle(lane.brick.store, i));
  }
}

template <int Dim>
void for_each_bond(Strip<Dim>& strip, const BondVisitor& visit) {
  strip.complete_halo();
  const PeriodicBox& box = strip.world().grid.box();
  for (const Lane<Dim>& lane : strip.lanes()) {
    const BondSet<Dim>& bonds = lane.brick.bonds;
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(bonds.bonds().size()); ++i) {
      if (!lane.brick.counts_bond(i)) continue;
      const double *a = lane.brick.store.x(bonds.end_a(i)), *b = lane.brick.store.x(bonds.end_b(i));
      Vec3 first = Vec3::Zero(), second = Vec3::Zero();
      for (int c = 0; c < Dim; ++c) {
        first[c] = a[c];
        second[c] = a[c] + box.nearest(b[c] - a[c], c);
      }
      visit(data_of(bonds.bonds()[static_cast<std::size_t>(i)]), first, second);
    }
  }
}

template <int Dim>
void apply_forces(Strip<Dim>& strip, const std::function<Vec3(const OwnedParticle&)>& force) {
  constexpr std::size_t kForce = Layout<Dim>::kForce;
  for (Lane<Dim>& lane : strip.lanes()) {
    auto& store = lane.brick.store;
    store.external.assign(static_cast<std::size_t>(store.num_owned) * kForce, 0.0);
    for (std::int32_t i = 0; i < store.num_owned; ++i) {
      const Vec3 f = force(particle(store, i));
      double* to = store.external.data() + static_cast<std::size_t>(i) * kForce;
      for (int c = 0; c < Dim; ++c) to[c] = f[c];
    }
  }
}

template <int Dim>
Measures measure(RunParts<Dim>& run) {
  run.strip.complete_halo();
  Measures all;
  std::vector<WallSums> walls(run.world.walls.size());
  for (Lane<Dim>& lane : run.strip.lanes()) {
    all.add(barchan::measure(lane.brick, run.model.gravity));
    const auto sums = measure_walls(lane.brick);
    for (std::size_t w = 0; w < sums.size(); ++w) walls[w].add(sums[w]);
  }
  reduce(run.communicator, run.world, all, walls);
  for (std::size_t w = 0; w < walls.size(); ++w) {
    WallState& wall = run.world.walls[w];
    for (int c = 0; c < 3; ++c) {
      wall.force[c] = walls[w].force[c].value();
      wall.torque[c] = walls[w].torque[c].value();
    }
    wall.work = walls[w].work.value();
    wall.heat_flow = walls[w].heat_flow.value();
  }
  return all;
}

template <int Dim>
std::uint64_t digest(const Strip<Dim>& strip) {
  std::uint64_t sum = 0;
  for (const Lane<Dim>& lane : strip.lanes()) sum += barchan::digest(lane.brick);
  strip.communicator().allreduce_sum(std::span(&sum, 1));
  return sum;
}

template <int Dim>
Timings timings_of(const RunParts<Dim>& run, const StepTimes& steps, const LoopSeconds& loop) {
  const SearchSeconds search = search_of(run.strip);
  const bool is_alone = run.communicator.size() == 1;
  const RebuildWaits waits = is_alone ? RebuildWaits{} : run.rebuild.waits();
  const double reductions = is_alone ? 0.0 : loop.reductions;
  Timings t;
  t.loop_seconds = loop.loop;
  t.steps = loop.steps;
  t.phases = {{"forces", steps.chunks - search.chunks},
              {"bands", steps.bands - search.bands},
              {"send", steps.send},
              {"poll", steps.poll},
              {"wait", steps.wait},
              {"rebuild", loop.rebuilds - search.rebuild - waits.sum()},
              {"rebuild_wait", waits.sum()},
              {"reduction_wait", reductions},
              {"search", search.chunks + search.bands + search.rebuild}};
  const double shadows = to_seconds(run.strip.shadow_ns()) / run.strip.num_lanes();
  if (run.strip.has_shadows()) t.phases["shadows"] = shadows;
  if (loop.checkpoints > 0.0) t.phases["checkpoint"] = loop.checkpoints;
  double rest = loop.loop;
  for (const auto& [name, seconds] : t.phases) rest -= seconds;
  // Within steps: tasks that start, and workers that wait for each other.
  const double tasks =
      steps.run - steps.chunks - steps.bands - steps.send - steps.poll - steps.wait - shadows;
  t.phases["tasks"] = std::clamp(tasks, 0.0, std::max(0.0, rest));
  t.phases["between_steps"] = std::max(0.0, rest - t.phases["tasks"]);
  if (run.strip.exchange() != nullptr) t.exchange = run.strip.exchange()->stats();
  const double in_flight = steps.in_flight + to_seconds(run.strip.shadow_flight_ns());
  t.communication = {{"halo", {in_flight, steps.exposed(), steps.late}},
                     {"rebuild", {waits.in_flight + waits.halo, waits.sum(), waits.late}},
                     {"reductions", {reductions, reductions}}};
  for (const auto& [name, kind] : t.communication) {
    t.in_flight_seconds += std::max(kind.in_flight, kind.exposed);
    t.exposed_seconds += kind.exposed;
  }
  t.rebuilds = run.rebuild.num_rebuilds();
  t.migrations = run.rebuild.num_migrations();
  return t;
}

template void for_each_owned(const Strip<2>&, const std::function<void(const OwnedParticle&)>&);
template void for_each_bond(Strip<2>&, const BondVisitor&);
template void apply_forces(Strip<2>&, const std::function<Vec3(const OwnedParticle&)>&);
template Measures measure(RunParts<2>&);
template std::uint64_t digest(const Strip<2>&);
template Timings timings_of(const RunParts<2>&, const StepTimes&, const LoopSeconds&);
template void for_each_owned(const Strip<3>&, const std::function<void(const OwnedParticle&)>&);
template void for_each_bond(Strip<3>&, const BondVisitor&);
template void apply_forces(Strip<3>&, const std::function<Vec3(const OwnedParticle&)>&);
template Measures measure(RunParts<3>&);
template std::uint64_t digest(const Strip<3>&);
template Timings timings_of(const RunParts<3>&, const StepTimes&, const LoopSeconds&);

}  // namespace barchan
