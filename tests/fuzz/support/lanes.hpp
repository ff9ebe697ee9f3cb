#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <barchan/core/brick/checkpoint.hpp>
#include <barchan/core/brick/halo.hpp>
#include <barchan/core/brick/lane.hpp>
#include <barchan/core/brick/measure.hpp>
#include <barchan/core/model/model.hpp>
#include <barchan/core/particles/share.hpp>

#include "unit/core/lane_fixture.hpp"

namespace barchan::fuzz {

using Bytes = std::vector<std::byte>;

/// Two small lanes beside each other with contacts, bonds and walls, which exchange messages; one
/// message is for the caller to change.
template <int Dim>
class Sample {
 public:
  /// @param returns  the published exchange: the lane on the right computes the pairs of the cut
  explicit Sample(bool returns = false) : world_(make_world()) {
    for (auto& lane : lanes_) lane = std::make_unique<Lane<Dim>>(world_);
    lanes_[0]->brick.add_link(Side::Right);
    lanes_[0]->brick.band(Side::Right).returns = returns;
    lanes_[1]->brick.add_link(Side::Left);
    lanes_[1]->brick.band(Side::Left).returns = returns;
  }

  [[nodiscard]] const World<Dim>& world() const { return world_; }

  /// The model that a state of this world is held against.
  [[nodiscard]] Model model() const {
    Model model;
    model.dimension = Dim;
    model.domain = domain();
    model.walls = world_.wall_specs;
    model.bond_laws = world_.bond_laws;
    model.stages.resize(2);
    return model;
  }

  /// A rebuild that moves the cut, and two steps; `change` gets what comes to the lane on the
  /// right (`to_right`) or on the left.
  template <class Change>
  void arrivals(bool to_right, Change&& change) {
    seed();
    const int middle = cut(1) + (to_right ? -1 : 1);  // a slab changes its lane
    std::array<Bytes, 1> to_the_right, to_the_left;
    lanes_[0]->rebuild.begin(placement(0, middle), to_the_right);
    lanes_[1]->rebuild.begin(placement(1, middle), to_the_left);
    change(to_right ? to_the_right[0] : to_the_left[0]);
    lanes_[0]->rebuild.absorb(to_the_left[0]);
    lanes_[1]->rebuild.absorb(to_the_right[0]);
    for (auto& lane : lanes_) lane->rebuild.order();
    exchange_ghosts(true, [](Bytes&) {});
    step();
    step();
    save();
  }

  template <class Change>
  void ghosts(bool to_right, Change&& change) {
    seed_only();
    exchange_ghosts(to_right, change);
    step();
    step();
    save();
  }

  template <class Change>
  void halo(bool to_right, Change&& change) {
    seed();
    step(to_right, change);
    step();
    save();
  }

  template <class Change>
  void results(Change&& change) {
    seed();
    begin_step();
    lanes_[1]->step.finish_band(Side::Left);
    const std::vector<double> sent = returned_forces();
    const auto raw = std::as_bytes(std::span(sent));
    Bytes message(raw.begin(), raw.end());
    change(message);
    std::vector<double> received(message.size() / sizeof(double));
    if (!received.empty())
      std::memcpy(received.data(), message.data(), received.size() * sizeof(double));
    lanes_[0]->step.finish_right_band(received);
    save();
  }

  /// One lane goes on from a share that was checked.
  void restore(const CheckpointShare& share) {
    Lane<Dim> lane(world_);
    barchan::restore(lane.brick, lane.rebuild,
                     {box_of_slabs(world_.grid, 0, world_.grid.num_slabs()), {}}, share);
    lane.rebuild.order();
    lane.lists.list_owned();
    lane.rebuild.take_ghosts({});
    lane.rebuild.restore_history();
    lane.lists.cut_chunks(64);
    for (int n = 0; n < 2; ++n) {
      lane.step.begin({world_.dt, {}, 0.0});
      for (int c = 0; c < lane.brick.num_chunks(); ++c) lane.step.run_chunk(c);
    }
    CheckpointShare again;
    barchan::save(lane.brick, again);
    (void)barchan::measure(lane.brick, Vec3::Zero());
  }

 private:
  [[nodiscard]] std::vector<double> returned_forces() {
    std::vector<double> forces;
    take_results(lanes_[1]->brick, forces);
    return forces;
  }

  static Domain domain() {
    Domain domain;
    domain.hi = Vec3(7.0, Dim == 3 ? 1.5 : 2.4, Dim == 3 ? 1.5 : 0.0);
    return domain;
  }

  static World<Dim> make_world() {
    World<Dim> w = test::world_of<Dim>(domain(), 1.1, 0.1, 40, true);
    BondLaw law;
    law.young_modulus = 1e5;
    law.tensile_strength = 1e4;
    w.bond_laws = {law};
    WallSpec floor, plate;
    floor.normal = plate.normal = Vec3(0.0, 1.0, 0.0);
    plate.kind = WallKind::Plate;
    plate.point = Vec3(3.0, 2.0, 1.0);
    plate.width = plate.depth = 1.0;
    plate.velocity = Vec3(0.0, -0.1, 0.0);
    w.set_walls(std::array{floor, plate});
    return w;
  }

  [[nodiscard]] int cut(std::size_t l) const {
    return l == 0 ? 0 : (l == 1 ? world_.grid.num_slabs() / 2 : world_.grid.num_slabs());
  }

  /// Of a lane where the second one begins at `middle`.
  [[nodiscard]] Placement<Dim> placement(std::size_t l, int middle) const {
    const CellBox<Dim> left = box_of_slabs(world_.grid, 0, middle),
                       right = box_of_slabs(world_.grid, middle, world_.grid.num_slabs());
    return l == 0 ? Placement<Dim>{left, {right}} : Placement<Dim>{right, {left}};
  }

  void seed_only() {
    const auto all = test::random_particles(Dim, domain(), Dim == 2 ? 32 : 40, 0.5, 5);
    std::vector<BondData> bonds;
    std::vector<double> lengths;
    for (std::size_t p = 0; p < all.size(); ++p) {
      for (std::size_t q = p + 1; q < all.size() && bonds.size() < 12; ++q) {
        const double length = (all[p].position - all[q].position).norm();
        if (length > 0.7) continue;
        bonds.push_back({std::min(all[p].id, all[q].id), std::max(all[p].id, all[q].id), 0});
        lengths.push_back(length);
      }
    }
    for (const std::size_t l : {std::size_t{0}, std::size_t{1}}) {
      std::vector<ParticleData> mine;
      for (const auto& p : all) {
        const int slab = world_.grid.coordinate(p.position.data(), 0);
        if (slab >= cut(l) && slab < cut(l + 1)) mine.push_back(p);
      }
      const std::vector<char> bonded(mine.size(), 1);
      lanes_[l]->rebuild.seed(placement(l, cut(1)), mine, bonds, lengths, bonded);
      lanes_[l]->rebuild.order();
    }
  }

  void seed() {
    seed_only();
    exchange_ghosts(true, [](Bytes&) {});
    step();
  }

  template <class Change>
  void exchange_ghosts(bool to_right, Change&& change) {
    Bytes left, right;  // to the lane on that side
    lanes_[0]->rebuild.pack_ghosts(0, right);
    lanes_[1]->rebuild.pack_ghosts(0, left);
    change(to_right ? right : left);
    for (auto& lane : lanes_) lane->lists.list_owned();
    const std::array<std::span<const std::byte>, 1> of_left{left}, of_right{right};
    lanes_[0]->rebuild.take_ghosts(of_left);
    lanes_[1]->rebuild.take_ghosts(of_right);
    for (auto& lane : lanes_) {
      lane->rebuild.restore_history();
      lane->lists.cut_chunks(64);
    }
  }

  void begin_step() {
    for (auto& lane : lanes_) {
      lane->step.begin({world_.dt, {}, 0.0});
      for (int c = 0; c < lane->brick.num_chunks(); ++c) lane->step.run_chunk(c);
    }
  }

  template <class Change>
  void step(bool to_right, Change&& change) {
    begin_step();
    lanes_[1]->step.finish_band(Side::Left);
    if (lanes_[0]->brick.band(Side::Right).returns)
      lanes_[0]->step.finish_right_band(returned_forces());
    else
      lanes_[0]->step.finish_band(Side::Right);
    Bytes right(halo_bytes(lanes_[0]->brick, 0)), left(halo_bytes(lanes_[1]->brick, 0));
    pack_halo(lanes_[0]->brick, 0, right);
    pack_halo(lanes_[1]->brick, 0, left);
    change(to_right ? right : left);
    unpack_halo(lanes_[0]->brick, 0, left);
    unpack_halo(lanes_[1]->brick, 0, right);
  }
  void step() {
    step(true, [](Bytes&) {});
  }

  void save() {
    CheckpointShare share;
    for (auto& lane : lanes_) {
      barchan::save(lane->brick, share);
      (void)barchan::measure(lane->brick, Vec3::Zero());
      (void)barchan::travel(lane->brick);
    }
  }

  World<Dim> world_;
  std::array<std::unique_ptr<Lane<Dim>>, 2> lanes_;
};

}  // namespace barchan::fuzz
