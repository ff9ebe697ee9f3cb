#include <barchan/core/brick/step.hpp>

#include <cmath>
#include <utility>

#include <barchan/core/brick/dissipation.hpp>
#include <barchan/core/brick/halo.hpp>
#include <barchan/core/brick/heat.hpp>
#include <barchan/core/brick/packing.hpp>
#include <barchan/core/brick/prefetch.hpp>
#include <barchan/core/simd/denormals.hpp>

namespace barchan {
namespace {

/// Steps whose work on walls a sum can hold: a million contacts each.
constexpr std::int64_t kCarryEvery = 512;

/// Of a component of velocity, beyond which step_travel() is looked at [m/s].
template <int Dim>
double quick_speed(const World<Dim>& world) {
  return world.quick_travel / (std::sqrt(double{Dim}) * world.dt);
}

template <int Dim>
void judge_speeds(Brick<Dim>& brick, double dt, Rows rows) {
  const World<Dim>& world = *brick.world;
  const double travel = farthest_travel(brick.store, dt, rows);
  brick.is_fast = brick.is_fast || !(travel <= world.most_travel(brick.skin));
  brick.has_quick = brick.has_quick || travel > world.quick_travel;
}

}  // namespace

template <int Dim>
PairJob Step<Dim>::job(PairList& list, PairBlock& block, double travel) {
  ParticleStore<Dim>& store = brick_.store;
  PairJob job;
  job.motion = store.motion.data();
  job.spin = store.spin.data();
  job.force = store.force.data();
  job.i = list.i.data();
  job.j = list.j.data();
  job.code = list.code.data();
  job.history = list.history.data();
  job.begin = block.begin;
  job.end = block.end;
  job.dt = frame_.last_dt;
  job.box = brick_.world->grid.box();
  job.laws = brick_.world->laws.view();
  if (brick_.world->packs()) pick_touching(brick_, list, block, travel, job);
  return job;
}

template <int Dim>
void Step<Dim>::press_plates(const StepFrame& frame, std::span<WallSums> sums) {
  const simd::DenormalsAreZero quiet;
  brick_.walls.press(brick_.store, wall_frame(frame), sums);
}

template <int Dim>
void Step<Dim>::begin(const StepFrame& frame) {
  const simd::DenormalsAreZero quiet;
  const World<Dim>& world = *brick_.world;
  frame_ = frame;
  wraps_ = world.grid.box().any() && (frame.step + 1) % kEventSteps == 0;
  brick_.step_travel = brick_.speeds.top * world.last_dt;
  brick_.travel += brick_.step_travel;
  brick_.speeds = {};
  brick_.top_flow = 0.0;
  looks_ = std::exchange(brick_.has_quick, false) && frame_.has_moved();
  if (world.search == ContactSearchKind::AllPairs) lists_.search_owned_again();
  if (looks_) PassageWatch<Dim>(world, brick_.store, brick_.passage).look_at(brick_.pairs);
  rows_done_ = brick_.interior.begin;
  brick_.wall_sums.resize(world.walls.size());
  if (++num_steps_ % kCarryEvery == 0) {
    for (WallSums& sums : brick_.wall_sums) sums.work.carry();
    for (ExactSum& sum : brick_.works.sums) sum.carry();
  }
  brick_.bonds.begin_step(frame.step);
  if (!brick_.bonds.empty()) compute_bonds(BondSet<Dim>::Owned);
}

template <int Dim>
void Step<Dim>::run_chunk(int chunk) {
  const simd::DenormalsAreZero quiet;
  const auto c = static_cast<std::size_t>(chunk);
  for (int b = brick_.chunks[c]; b < brick_.chunks[c + 1]; ++b)
    run_block(brick_.blocks[static_cast<std::size_t>(b)]);
}

template <int Dim>
void Step<Dim>::run_block(RowBlock& block) {
  const PairJob pairs = job(brick_.pairs, block, brick_.travel);
  if (counts_losses()) dissipate(brick_, pairs, frame_.kick, true);
  if (brick_.prefetches)
    run_with_prefetch(brick_, block, pairs);
  else
    brick_.world->kernels.pairs(pairs);
  if (brick_.store.has_heat) conduct(brick_, pairs);
  if (block.final_row <= rows_done_) return;
  finish_rows({rows_done_, block.final_row}, block.has_extras);
  rows_done_ = block.final_row;
}

/// Into the extra forces of these rows: bonds, walls, callers.
template <int Dim>
void Step<Dim>::add_extras(Rows rows) {
  ParticleStore<Dim>& store = brick_.store;
  if (frame_.has_moved())
    PassageWatch<Dim>(*brick_.world, store, brick_.passage).look_at(brick_.walls.list(), rows);
  const auto book = [&](EnergyWorks::Part part) {
    if (brick_.world->accounts) account_.book(store, part);
  };
  store.start_extra(rows.begin, rows.end);
  brick_.bonds.add_to_rows(store, rows.begin, rows.end);
  book(EnergyWorks::Bonds);
  brick_.walls.add_to_rows(store, wall_frame(frame_), brick_.wall_sums, rows.begin, rows.end);
  book(EnergyWorks::Contacts);
  dissipate(brick_, wall_losses_);
  wall_losses_.clear();
  if (store.external.empty()) return;
  constexpr auto kForce = std::size_t{Layout<Dim>::kForce};
  const auto from = static_cast<std::size_t>(rows.begin) * kForce,
             to = static_cast<std::size_t>(rows.end) * kForce;
  for (std::size_t c = from; c < to; ++c) store.extra[c - from] += store.external[c];
  book(EnergyWorks::Callers);
}

template <int Dim>
void Step<Dim>::finish_rows(Rows rows, bool has_extras) {
  const World<Dim>& world = *brick_.world;
  if (!world.accounts) {
    advance_rows(rows, has_extras);
  } else {
    account_.begin(brick_.store, rows, world.grain.rounder());
    advance_rows(rows, has_extras);
    account_.end(brick_.store, frame_.kick, frame_.gravity, frame_.local_damping != 0.0,
                 brick_.works);
  }
  if (wraps_) wrap_rows(rows);
}

template <int Dim>
void Step<Dim>::advance_rows(Rows rows, bool has_extras) {
  const World<Dim>& world = *brick_.world;
  ParticleStore<Dim>& store = brick_.store;
  const bool has_more = has_extras || !store.external.empty();
  if (has_more) add_extras(rows);
  if (store.has_heat) warm(brick_, rows);
  const RowJob job{store.motion.data(),
                   store.spin.data(),
                   store.force.data(),
                   rows.begin,
                   rows.end,
                   frame_.kick,
                   world.dt,
                   {frame_.gravity[0], frame_.gravity[1], frame_.gravity[2]},
                   frame_.local_damping,
                   quick_speed(world),
                   world.grain.rounder(),
                   has_more ? store.extra.data() : nullptr};
  const RowKernel advance =
      frame_.local_damping != 0.0 ? world.kernels.rows_damped : world.kernels.rows;
  const RowSpeeds speeds = advance(job);
  brick_.speeds.add(speeds);
  if (speeds.is_beyond) judge_speeds(brick_, world.dt, rows);
}

/// At fixed steps, for what a position loses around the end of the box is part of the state.
template <int Dim>
void Step<Dim>::wrap_rows(Rows rows) {
  const World<Dim>& world = *brick_.world;
  brick_.walls.foresee_wrap(brick_.store, world.grid, world.wall_shapes, rows);
  for (std::int32_t i = rows.begin; i < rows.end; ++i) world.grid.wrap(brick_.store.x(i));
}

template <int Dim>
void Step<Dim>::finish_band(Side side) {
  const simd::DenormalsAreZero quiet;
  const World<Dim>& world = *brick_.world;
  Band& band = brick_.band(side);
  if (world.search == ContactSearchKind::AllPairs) lists_.search_across_again(side);
  if (looks_ || (band.has_quick && frame_.has_moved()))
    PassageWatch<Dim>(world, brick_.store, brick_.passage).look_at(band.across);
  // Bonds come before contacts here too, as in begin: a pair whose bond breaks is in contact in the
  // same step.
  if (!brick_.bonds.empty())
    compute_bonds(side == Side::Left ? BondSet<Dim>::Left : BondSet<Dim>::Right);
  for (PairBlock& block : band.blocks) {
    const PairJob pairs = job(band.across, block, 0.5 * (brick_.travel + band.travel));
    if (counts_losses()) dissipate(brick_, pairs, frame_.kick, side == Side::Left);
    world.kernels.pairs(pairs);
    if (brick_.store.has_heat) conduct(brick_, pairs);
  }
  if (band.rows.begin < band.rows.end) finish_rows(band.rows, true);
}

template <int Dim>
void Step<Dim>::finish_right_band(std::span<const double> results) {
  const simd::DenormalsAreZero quiet;
  add_results(brick_, results);
  finish_rows(brick_.band(Side::Right).rows, true);
}

template <int Dim>
void Step<Dim>::compute_bonds(typename BondSet<Dim>::Group group) {
  const World<Dim>& world = *brick_.world;
  const auto broken =
      brick_.bonds.compute(group, brick_.store, world.bond_laws, world.grid.box(), frame_.last_dt);
  if (broken.empty()) return;
  // Laws change. Bonds across a cut are pairs across it.
  if (group == BondSet<Dim>::Owned) {
    for (PairBlock& block : brick_.blocks) unpack(brick_.pairs, block);
  } else {
    Band& band = brick_.band(group == BondSet<Dim>::Left ? Side::Left : Side::Right);
    for (PairBlock& block : band.blocks) unpack(band.across, block);
  }
  for (const std::int32_t bond : broken) unbind(bond);
  lists_.list_bonded();
}

template <int Dim>
void Step<Dim>::unbind(std::int32_t bond) {
  const std::int32_t a = brick_.bonds.end_a(bond), b = brick_.bonds.end_b(bond);
  const PairPlace at = place_of(brick_, a, b);
  if (at.list == nullptr) return;  // too far apart to be candidates
  const auto& type = brick_.store.type;
  at.list->code[static_cast<std::size_t>(at.k)] =
      brick_.world->laws.code(type[static_cast<std::size_t>(a)], type[static_cast<std::size_t>(b)]);
}

template <int Dim>
void find_quick(Brick<Dim>& brick) {
  brick.has_quick = false;
  judge_speeds(brick, brick.world->last_dt, {0, brick.store.num_owned});
  for (Band& band : brick.bands) band.has_quick = false;
  for (BrickLink<Dim>& link : brick.links) {
    link.has_quick =
        farthest_travel(brick.store, brick.world->last_dt, link.ghosts) > brick.world->quick_travel;
    Band& band = brick.band(link.side);
    band.has_quick = band.has_quick || link.has_quick;
  }
}

template class Step<2>;
template class Step<3>;
template void find_quick(Brick<2>&);
template void find_quick(Brick<3>&);

}  // namespace barchan
