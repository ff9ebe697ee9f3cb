#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <barchan/core/brick/brick.hpp>
#include <barchan/core/checkpoint/state.hpp>
#include <barchan/tasks/lane_map.hpp>
#include <barchan/tasks/particle_view.hpp>
#include <barchan/tasks/rebuild_schedule.hpp>
#include <barchan/tasks/state.hpp>
#include <barchan/tasks/watch.hpp>

namespace barchan {

/// What a State holds, free of the dimension.
struct State::Data {
  explicit Data(Generation the_owner) : owner(std::move(the_owner)) {}
  virtual ~Data() = default;
  [[nodiscard]] virtual std::size_t bytes() const = 0;

  Generation owner;  ///< of the simulation that it is of
  std::int64_t step = 0;
};

/// Bricks are plain data, so a state is a copy of them with ghosts up to date, and of what stands
/// beside them: lists, too, so that a step finds all as it was.
template <int Dim>
struct StateOf final : State::Data {
  using Data::Data;
  [[nodiscard]] std::size_t bytes() const override;

  std::vector<Brick<Dim>> bricks;
  Cuts cuts;
  std::vector<WallState> walls;
  std::vector<Vec3> walls_at_renewal;
  std::vector<double> loads;  ///< of walls
  std::vector<Vec3> normals;  ///< of walls
  Vec3 gravity = Vec3::Zero();
  ContactTable contacts;
  RebuildSchedule::Memory schedule;
  CheckpointState stages;  ///< the fields of stages alone
  TimePoint since;
  double dt = 0.0, last_dt = 0.0;
  std::int64_t num_particles = 0;
  LeftDomain left;
  typename Watch<Dim>::Memory watch;
  double skin = 0.0, quick_travel = 0.0;
  bool is_over = false, has_account = false;
};

}  // namespace barchan
