#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include <barchan/core/base/error.hpp>
#include <barchan/core/brick/lane.hpp>
#include <barchan/core/particles/fields.hpp>
#include <barchan/core/simd/denormals.hpp>

namespace barchan {
namespace {

/// Steps whose work on walls a sum can hold: a million contacts each.
constexpr std::int64_t kCarryEvery = 512;

/// Time over which springs stretch.
double spring_step(const StepFrame& frame, double dt) {
  return frame.has_moved(dt) ? dt : 0.0;
}

}  // namespace

template <int Dim>
PairJob Lane<Dim>::job(PairList& list) const {
  PairJob job;
  auto& store = const_cast<Store&>(store_);
  job.motion = store.motion.data();
  job.spin = store.spin.data();
  job.force = store.force.data();
  job.i = list.i.data();
  job.j = list.j.data();
  job.code = list.code.data();
  job.history = list.history.data();
  job.begin = 0;
  job.end = list.size();
  job.dt = spring_step(frame_, world_->dt);
  job.box = world_->grid.box();
  job.laws = world_->laws.view();
  return job;
}

template <int Dim>
void Lane<Dim>::press_plates(const StepFrame& frame, std::span<WallSums> sums) {
  const simd::DenormalsAreZero quiet;
  walls_.press(store_, wall_frame(spring_step(frame, world_->dt)), sums);
}

template <int Dim>
void Lane<Dim>::begin_step(const StepFrame& frame) {
  const simd::DenormalsAreZero quiet;
  frame_ = frame;
  wraps_now_ = world_->grid.box().any() && (frame.step + 1) % kEventSteps == 0;
  step_travel_ = speeds_.top * world_->dt;
  travel_ += step_travel_;
  speeds_ = {};
  looks_ = std::exchange(has_quick_, false) && frame_.has_moved(world_->dt);
  if (world_->search == ContactSearchKind::AllPairs) research_owned();
  if (looks_) PassageWatch<Dim>(*world_, store_, passage_).look_at(pairs_);
  rows_done_ = band(Side::Left).exists ? band(Side::Left).rows.end : 0;
  wall_sums_.resize(world_->walls.size());
  const bool is_carry_due = ++steps_since_start_ % kCarryEvery == 0;
  for (WallSums& sums : wall_sums_) {
    if (is_carry_due) sums.work.carry();
  }
  if (!bonds_.empty()) compute_bonds(BondSet<Dim>::Owned);
}

template <int Dim>
void Lane<Dim>::run_chunk(int chunk) {
  const simd::DenormalsAreZero quiet;
  const auto c = static_cast<std::size_t>(chunk);
  for (int b = chunks_[c]; b < chunks_[c + 1]; ++b) run_block(blocks_[static_cast<std::size_t>(b)]);
}

template <int Dim>
void Lane<Dim>::run_block(Block& block) {
  const PairJob pairs = block_job(pairs_, block, travel_);
  if (prefetches_)
    run_with_prefetch(block, pairs);
  else
    world_->kernels.pairs(pairs);
  if (block.final_row > rows_done_) {
    finish_rows(rows_done_, block.final_row, block.has_extras);
    rows_done_ = block.final_row;
  }
}

template <int Dim>
void Lane<Dim>::finish_rows(std::int32_t begin, std::int32_t end, bool has_extras) {
  const bool has_more = has_extras || !store_.external.empty();
  if (has_more) {
    if (frame_.has_moved(world_->dt))
      PassageWatch<Dim>(*world_, store_, passage_).look_at(walls_.list(), {begin, end});
    store_.start_extra(begin, end);
    bonds_.add_to_rows(store_, begin, end);
    const double dt = spring_step(frame_, world_->dt);
    walls_.add_to_rows(store_, wall_frame(dt), wall_sums_, begin, end);
    if (!store_.external.empty()) {
      const auto from = static_cast<std::size_t>(begin) * L::kForce,
                 to = static_cast<std::size_t>(end) * L::kForce;
      for (std::size_t c = from; c < to; ++c) store_.extra[c - from] += store_.external[c];
    }
  }
  RowJob rows{store_.motion.data(),
              store_.spin.data(),
              store_.force.data(),
              begin,
              end,
              frame_.kick,
              world_->dt,
              {frame_.gravity[0], frame_.gravity[1], frame_.gravity[2]},
              frame_.local_damping,
              quick_speed(),
              world_->grain.rounder(),
              has_more ? store_.extra.data() : nullptr};
  const RowKernel advance =
      frame_.local_damping != 0.0 ? world_->kernels.rows_damped : world_->kernels.rows;
  const RowSpeeds speeds = advance(rows);
  speeds_.add(speeds);
  if (speeds.is_beyond) judge_speeds({begin, end});
  if (wraps_now_) wrap_rows({begin, end});
}

template <int Dim>
void Lane<Dim>::judge_speeds(Rows rows) {
  const double travel = farthest_travel(store_, world_->dt, rows);
  is_beyond_ = is_beyond_ || is_beyond(travel);
  has_quick_ = has_quick_ || travel > world_->quick_travel;
}

/// At fixed steps, for what a position loses around the end of the box is part of the state.
template <int Dim>
void Lane<Dim>::wrap_rows(Rows rows) {
  walls_.foresee_wrap(store_, world_->grid, world_->wall_shapes, rows);
  for (std::int32_t i = rows.begin; i < rows.end; ++i) world_->grid.wrap(store_.x(i));
}

template <int Dim>
void Lane<Dim>::unpack_halo(Side side, std::span<const std::byte> message) {
  const std::int32_t begin = store_.ghost_begin(side), n = store_.num_ghosts[index_of(side)];
  if (message.size() != static_cast<std::size_t>(n) * halo_record_bytes<Dim>()) {
    throw RunError("a halo message has " + std::to_string(message.size()) + " bytes for " +
                   std::to_string(n) + " ghosts");
  }
  const std::byte* from = message.data();
  double top2 = 0.0;
  for (std::int32_t g = begin; g < begin + n; ++g) {
    for_each_field<Dim>([&]<class T>(const Field<Dim, T>& field) {
      if (!field.is_in_halo) return;
      const std::size_t bytes = static_cast<std::size_t>(field.width) * sizeof(T);
      std::memcpy(field.of(store_, g), from, bytes);
      from += bytes;
    });
    const double* v = store_.v(g);
    top2 = std::max(top2, v[0] * v[0] + v[1] * v[1] + (Dim == 3 ? v[2] * v[2] : 0.0));
  }
  const double travel = std::sqrt(top2) * world_->dt;
  band(side).travel += travel;
  band(side).has_quick = travel > world_->quick_travel;
}

template <int Dim>
std::size_t Lane<Dim>::halo_bytes(Side side) const {
  const Rows rows = band(side).rows;
  return static_cast<std::size_t>(rows.end - rows.begin) * halo_record_bytes<Dim>();
}

template <int Dim>
void Lane<Dim>::pack_halo(Side side, std::span<std::byte> message) const {
  std::byte* to = message.data();
  const Rows rows = band(side).rows;
  for (std::int32_t i = rows.begin; i < rows.end; ++i) {
    for_each_field<Dim>([&]<class T>(const Field<Dim, T>& field) {
      if (!field.is_in_halo) return;
      const std::size_t bytes = static_cast<std::size_t>(field.width) * sizeof(T);
      std::memcpy(to, field.of(store_, i), bytes);
      to += bytes;
    });
  }
}

template <int Dim>
void Lane<Dim>::finish_band(Side side) {
  const simd::DenormalsAreZero quiet;
  Band& band = this->band(side);
  if (world_->search == ContactSearchKind::AllPairs) research_across(side);
  if (looks_ || (band.has_quick && frame_.has_moved(world_->dt)))
    PassageWatch<Dim>(*world_, store_, passage_).look_at(band.across);
  // Bonds come before contacts here too, as in begin_step: a pair whose bond breaks is in contact
  // in the same step.
  if (!bonds_.empty()) compute_bonds(BondSet<Dim>::across(side));
  for (PairBlock& block : band.blocks)
    world_->kernels.pairs(block_job(band.across, block, 0.5 * (travel_ + band.travel)));
  finish_rows(band.rows.begin, band.rows.end, true);
}

template <int Dim>
void Lane<Dim>::compute_bonds(typename BondSet<Dim>::Group group) {
  const auto broken = bonds_.compute(group, store_, world_->bond_laws, world_->grid.box(),
                                     spring_step(frame_, world_->dt));
  for (const std::int32_t bond : broken) unbind(bond);
  if (broken.empty()) return;
  list_bonded();
  // Laws have changed. Bonds across a cut are pairs across it.
  if (group == BondSet<Dim>::Owned)
    unpack_history();
  else
    unpack_history_across(group == BondSet<Dim>::Left ? Side::Left : Side::Right);
}

template <int Dim>
void Lane<Dim>::unbind(std::int32_t bond) {
  const std::int32_t a = bonds_.end_a(bond), b = bonds_.end_b(bond);
  const Slot at = slot(a, b);
  if (at.list == nullptr) return;  // too far apart to be candidates
  const auto law = world_->laws.code(store_.type[static_cast<std::size_t>(a)],
                                     store_.type[static_cast<std::size_t>(b)]);
  at.list->code[static_cast<std::size_t>(at.k)] = law;
}

template class Lane<2>;
template class Lane<3>;

}  // namespace barchan
