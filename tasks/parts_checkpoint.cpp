#include <barchan/tasks/parts_checkpoint.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <tuple>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/brick/checkpoint.hpp>

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

WallState restored(const SavedWall& s) {
  return {vec(s.point), vec(s.velocity), s.is_active != 0.0, vec(s.force), vec(s.torque), s.work};
}

/// Sums over all lanes, which may as well be the first one's.
template <int Dim>
void restore_totals(Lane<Dim>& first, std::span<const std::int64_t> totals) {
  first.brick.bonds.set_num_broken(totals[0]);
  first.brick.wall_sums.resize(first.brick.world->walls.size());
  auto digit = totals.begin() + 1;
  const auto take = [&](ExactSum& sum) {
    std::copy_n(digit, ExactSum::kDigits, sum.digits().begin());
    digit += ExactSum::kDigits;
  };
  for (WallSums& sums : first.brick.wall_sums) take(sums.work);
  if (!first.brick.world->accounts) return;
  for (ExactSum& sum : first.brick.works.sums) take(sum);
}

/// @return particles. Collective.
template <int Dim>
std::int64_t check_restored(RunParts<Dim>& run, const OpenCheckpoint& checkpoint) {
  std::int64_t found[4] = {};
  for (Lane<Dim>& lane : run.strip.lanes()) {
    CheckpointShare share;
    barchan::save(lane.brick, share);
    found[0] += static_cast<std::int64_t>(share.ids.size());
    found[1] += static_cast<std::int64_t>(share.contact_ids.size() / 2);
    found[2] += static_cast<std::int64_t>(share.wall_contact_ids.size());
    found[3] += static_cast<std::int64_t>(share.bond_laws.size());
  }
  run.communicator.allreduce_sum(std::span<std::int64_t>(found));
  const ManifestFile saved = checkpoint.manifest.totals();
  if (found[0] == saved.particles && found[1] == saved.contacts &&
      found[2] == saved.wall_contacts && found[3] == saved.bonds)
    return found[0];
  throw CommonError(
      fmt::format("{}: of {} particles, {} contacts, {} wall contacts and {} bonds only {}, {}, {} "
                  "and {} could be restored: "
                  "take another checkpoint",
                  checkpoint.path, saved.particles, saved.contacts, saved.wall_contacts,
                  saved.bonds, found[0], found[1], found[2], found[3]));
}

}  // namespace

template <int Dim>
void copy_lanes(RunParts<Dim>& run, StepGraph<Dim>& graph, double wall_outrun,
                CheckpointCopy& copy) {
  std::tie(copy.lo, copy.hi) = run.strip.extent();
  copy.shares.resize(run.strip.lanes().size());
  graph.for_each_lane([&](int l) {
    barchan::save(run.strip.lane(l).brick, copy.shares[static_cast<std::size_t>(l)]);
  });
  copy.shares[0].outruns.push_back(wall_outrun);
}

template <int Dim>
void save_parts(const RunParts<Dim>& run, CheckpointState& state) {
  state.skin = run.scale.skin;
  state.reach = run.scale.reach;
  state.start_particles = run.scale.num_particles;
  state.has_bonds = run.scale.has_bonds;
  state.grain = run.scale.grain.size;
  state.heat_grain = run.scale.heat_grain.size;
  state.overlap_limit = run.model.limits.overlap_error;
  for (const WallState& wall : run.world.walls) state.walls.push_back(saved(wall));
  state.fingerprint = fingerprint(run.model);
}

WorldScale scale_of(const CheckpointState& s, const Model& model) {
  const double skin = model.search.skin.value_or(s.skin);
  return {skin,
          s.reach - s.skin + skin,
          s.start_particles,
          s.has_bonds,
          grain_for_limit({s.grain}, s.overlap_limit, model.limits.overlap_error),
          grain_for_limit({s.heat_grain}, s.overlap_limit, model.limits.overlap_error),
          num_carried(s)};
}

template <int Dim>
std::int64_t restore_parts(RunParts<Dim>& run, const OpenCheckpoint& checkpoint) {
  for (std::size_t w = 0; w < run.world.walls.size(); ++w)
    run.world.walls[w] = restored(checkpoint.state.walls[w]);
  const LoadedShares loaded =
      load_shares<Dim>(run.communicator, checkpoint, run.model, run.world.grid, run.lanes);
  double& quick_travel = run.world.quick_travel;
  for (const CheckpointShare& share : loaded.shares) {
    for (const double radius : share.radii) quick_travel = std::min(quick_travel, 0.5 * radius);
  }
  run.communicator.allreduce_min(std::span(&quick_travel, 1));
  run.rebuild.restore(loaded.cuts, loaded.shares);
  const std::int64_t num_particles = check_restored(run, checkpoint);
  if (run.communicator.is_root()) restore_totals(run.strip.lane(0), loaded.totals);
  return num_particles;
}

template void copy_lanes(RunParts<2>&, StepGraph<2>&, double, CheckpointCopy&);
template void copy_lanes(RunParts<3>&, StepGraph<3>&, double, CheckpointCopy&);
template void save_parts(const RunParts<2>&, CheckpointState&);
template void save_parts(const RunParts<3>&, CheckpointState&);
template std::int64_t restore_parts(RunParts<2>&, const OpenCheckpoint&);
template std::int64_t restore_parts(RunParts<3>&, const OpenCheckpoint&);

}  // namespace barchan
