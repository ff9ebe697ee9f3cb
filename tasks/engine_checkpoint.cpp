#include <algorithm>
#include <chrono>
#include <tuple>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/tasks/engine.hpp>
#include <barchan/tasks/stop_request.hpp>
#include <barchan/tasks/strip_plan.hpp>

// A simulation into a checkpoint, and out of one.

namespace barchan {
namespace {

void put(const Vec3& from, double (&to)[3]) {
  for (int c = 0; c < 3; ++c) to[c] = from[c];
}

Vec3 vec(const double (&from)[3]) {
  return {from[0], from[1], from[2]};
}

SavedWall saved(const WallState& wall) {
  SavedWall s{};
  put(wall.point, s.point);
  put(wall.velocity, s.velocity);
  put(wall.force, s.force);
  put(wall.torque, s.torque);
  s.work = wall.work;
  s.is_active = wall.is_active ? 1.0 : 0.0;
  return s;
}

}  // namespace

template <int Dim>
void Simulation::EngineOf<Dim>::keep_checkpoints() {
  keeper_->poll();
  if (must_save_ || keeper_->is_due(step_)) save_checkpoint();
}

template <int Dim>
bool Simulation::EngineOf<Dim>::wants_checkpoint() const {
  return keeper_ != nullptr && (checkpoint_is_requested() || keeper_->is_overdue());
}

template <int Dim>
void Simulation::EngineOf<Dim>::save_checkpoint() {
  const auto begin = std::chrono::steady_clock::now();
  must_save_ = false;
  strip_->complete_halo();  // whether pairs across cuts touch
  CheckpointCopy& copy = keeper_->begin();
  copy.step = step_;
  copy.time = static_cast<double>(step_) * model_.time.step;
  std::tie(copy.lo, copy.hi) = strip_->extent();
  copy.shares.resize(static_cast<std::size_t>(strip_->num_lanes()));
  graph_->for_each_lane(
      [&](int l) { strip_->lane(l).save(copy.shares[static_cast<std::size_t>(l)]); });
  copy.shares[0].outruns.push_back(outrun_share(wall_distance2(), world_.skin));
  copy.state.clear();
  if (communicator_.is_root()) copy.state = encode(state());
  keeper_->start();
  if (!is_in_step_) return;  // outside of the loop
  checkpoint_seconds_ +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

template <int Dim>
CheckpointState Simulation::EngineOf<Dim>::state() {
  const RebuildSchedule::PendingLook look = schedule_->pending_look(step_);
  CheckpointState s;
  s.step = step_;
  s.stage = stage_;
  s.stage_begin = stage_begin_;
  s.skin = scale_.skin;
  s.reach = scale_.reach;
  s.start_particles = scale_.num_particles;
  s.has_bonds = scale_.has_bonds;
  s.num_particles = num_particles_;
  s.grain = scale_.grain.size;
  s.overlap_limit = model_.limits.overlap_error;
  s.look_step = look.step;
  s.look_outside = look.outside;
  s.look_overlap = look.overlap;
  s.left_particles = left_.particles;
  s.left_contacts = left_.links.contacts;
  s.left_wall_contacts = left_.links.wall_contacts;
  s.left_bonds = left_.links.bonds;
  for (const WallState& wall : world_.walls) s.walls.push_back(saved(wall));
  s.fingerprint = fingerprint(model_);
  return s;
}

template <int Dim>
Simulation::EngineOf<Dim>::EngineOf(const Model& model, const std::string& checkpoint,
                                    Communicator communicator, const RunOptions& options)
    : Engine(model, std::move(communicator), options) {
  const OpenCheckpoint open = open_checkpoint(communicator_, checkpoint, model_);
  const CheckpointState& s = open.state;
  restored_from_ = open.path;
  const double skin = model_.search.skin.value_or(s.skin);
  make_world({skin, s.reach - s.skin + skin, s.start_particles, s.has_bonds,
              grain_for_limit({s.grain}, s.overlap_limit, model_.limits.overlap_error)});
  make_strip();
  for (std::size_t w = 0; w < s.walls.size(); ++w) {
    world_.walls[w].is_active = s.walls[w].is_active != 0.0;
    walls_at_rebuild_[w] = world_.walls[w].point = vec(s.walls[w].point);
  }
  restore_particles(open);
  make_loop();
  restore(open);
}

template <int Dim>
void Simulation::EngineOf<Dim>::restore_particles(const OpenCheckpoint& checkpoint) {
  const LoadedShares loaded =
      load_shares<Dim>(communicator_, checkpoint, model_, world_.grid, strip_->num_lanes());
  for (const CheckpointShare& share : loaded.shares) {
    for (const double radius : share.radii)
      world_.quick_travel = std::min(world_.quick_travel, 0.5 * radius);
  }
  communicator_.allreduce_min(std::span(&world_.quick_travel, 1));
  strip_->restore(loaded.cuts, loaded.shares);
  check_restored(checkpoint);
  if (!communicator_.is_root()) return;
  // Sums over all lanes, which may as well be the first one's.
  Lane<Dim>& first = strip_->lane(0);
  first.bonds().set_num_broken(loaded.totals[0]);
  first.wall_sums().resize(world_.walls.size());
  auto digit = loaded.totals.begin() + 1;
  for (WallSums& sums : first.wall_sums()) {
    std::copy_n(digit, ExactSum::kDigits, sums.work.digits().begin());
    digit += ExactSum::kDigits;
  }
}

template <int Dim>
void Simulation::EngineOf<Dim>::check_restored(const OpenCheckpoint& checkpoint) {
  std::int64_t found[4] = {};
  for (int l = 0; l < strip_->num_lanes(); ++l) {
    CheckpointShare share;
    strip_->lane(l).save(share);
    found[0] += static_cast<std::int64_t>(share.ids.size());
    found[1] += static_cast<std::int64_t>(share.contact_ids.size() / 2);
    found[2] += static_cast<std::int64_t>(share.wall_contact_ids.size());
    found[3] += static_cast<std::int64_t>(share.bond_laws.size());
  }
  communicator_.allreduce_sum(std::span<std::int64_t>(found));
  num_particles_ = found[0];
  const ManifestFile saved = checkpoint.manifest.totals();
  if (found[0] == saved.particles && found[1] == saved.contacts &&
      found[2] == saved.wall_contacts && found[3] == saved.bonds)
    return;
  throw CommonError(
      fmt::format("{}: of {} particles, {} contacts, {} wall contacts and {} bonds only {}, {}, {} "
                  "and {} could be restored: "
                  "take another checkpoint",
                  checkpoint.path, saved.particles, saved.contacts, saved.wall_contacts,
                  saved.bonds, found[0], found[1], found[2], found[3]));
}

template <int Dim>
void Simulation::EngineOf<Dim>::restore(const OpenCheckpoint& checkpoint) {
  const CheckpointState& s = checkpoint.state;
  step_ = s.step;
  stage_ = s.stage;
  stage_begin_ = s.stage_begin;
  for (std::size_t w = 0; w < s.walls.size(); ++w) {
    WallState& wall = world_.walls[w];
    wall.velocity = vec(s.walls[w].velocity);
    wall.force = vec(s.walls[w].force);
    wall.torque = vec(s.walls[w].torque);
    wall.work = s.walls[w].work;
  }
  left_ = {s.left_particles, {s.left_contacts, s.left_wall_contacts, s.left_bonds}};
  schedule_->restore(step_, top_speed(), {s.look_step, s.look_outside, s.look_overlap},
                     communicator_.is_root() ? num_particles_ : 0);
}

template class Simulation::EngineOf<2>;
template class Simulation::EngineOf<3>;

}  // namespace barchan
