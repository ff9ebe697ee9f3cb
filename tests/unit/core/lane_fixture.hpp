#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include <barchan/core/brick/checkpoint.hpp>
#include <barchan/core/brick/diagnose.hpp>
#include <barchan/core/brick/halo.hpp>
#include <barchan/core/brick/lane.hpp>
#include <barchan/core/brick/measure.hpp>
#include <barchan/core/particles/share.hpp>

// Lanes side by side without ranks or threads: what passes between them goes from hand to hand.

namespace barchan::test {

inline ContactTable table_of(int num_materials, bool no_tension = true) {
  ContactTable t{num_materials, {}, no_tension};
  for (int a = 0; a < num_materials; ++a) {
    for (int b = 0; b < num_materials; ++b) {
      ContactConstants c;
      c.kn = 1e4 + 1e3 * (a + b);
      c.kt = 3e3 + 1e2 * (a * b);
      c.mu = 0.1 + 0.2 * (a + b);
      c.cn.constant = 3.0 + a + b;
      c.ct.constant = 1.0 + a * b;
      t.constants.push_back(c);
    }
  }
  return t;
}

template <int Dim>
World<Dim> world_of(const Domain& domain, double cutoff, double skin, std::int64_t num_particles,
                    bool has_bonds = false) {
  World<Dim> w;
  w.grid = Grid<Dim>(domain, cutoff);
  w.laws = LawTable(table_of(2));
  w.grain.size = 0x1p-30;
  w.kernels = make_kernels(Dim, VectorWidth::Scalar, w.laws, has_bonds, w.grid.box());
  w.skin = skin;
  w.dt = w.last_dt = 1e-4;
  w.num_particles = num_particles;
  return w;
}

/// Particles anywhere in the domain, radii in [0.6, 1]·radius, ids in no order.
inline std::vector<ParticleData> random_particles(int dimension, const Domain& domain, int count,
                                                  double radius, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<ParticleData> all(static_cast<std::size_t>(count));
  std::vector<std::int64_t> ids;
  for (int p = 0; p < count; ++p) ids.push_back(3 * p + 1);
  std::shuffle(ids.begin(), ids.end(), random);
  for (int p = 0; p < count; ++p) {
    auto& q = all[static_cast<std::size_t>(p)];
    q.id = ids[static_cast<std::size_t>(p)];
    q.type = p % 2;
    q.radius = radius * (0.6 + 0.4 * unit(random));
    q.density = 1000.0;
    q.fixed = p % 7 == 0;
    for (int a = 0; a < dimension; ++a) {
      q.position[a] = domain.lo[a] + unit(random) * (domain.hi[a] - domain.lo[a]);
      q.velocity[a] = unit(random) - 0.5;
      q.omega[a] = dimension == 3 ? unit(random) : 0.0;
    }
    if (dimension == 2) q.omega[2] = unit(random);
  }
  return all;
}

/// Springs by ids (lower, higher), as seen from the lower id.
using Springs = std::map<std::pair<std::int64_t, std::int64_t>, std::vector<double>>;

template <int Dim>
class Lanes {
 public:
  /// @param cuts  first slab of every lane, and the number of slabs
  Lanes(World<Dim>& world, std::vector<int> cuts) : world_(&world), cuts_(std::move(cuts)) {
    for (std::size_t l = 0; l + 1 < cuts_.size(); ++l)
      lanes_.push_back(std::make_unique<Lane<Dim>>(world));
    for (std::size_t l = 0; l < lanes_.size(); ++l) place_band(l);
  }

  void seed(std::span<const ParticleData> all, std::span<const BondData> bonds = {}) {
    std::map<std::int64_t, Vec3> at;
    for (const auto& p : all) at[p.id] = p.position;
    std::vector<double> lengths;
    for (const BondData& b : bonds) lengths.push_back((at[b.id_a] - at[b.id_b]).norm());
    for (std::size_t l = 0; l < lanes_.size(); ++l) {
      std::vector<ParticleData> mine;
      std::vector<char> bonded;
      for (const auto& p : all) {
        const int slab = world_->grid.coordinate(p.position.data(), 0);
        if (slab < cuts_[l] || slab >= cuts_[l + 1]) continue;
        mine.push_back(p);
        bonded.push_back(std::ranges::any_of(
                             bonds, [&](const auto& b) { return b.id_a == p.id || b.id_b == p.id; })
                             ? 1
                             : 0);
      }
      lanes_[l]->rebuild.seed(placement(l), mine, bonds, lengths, bonded);
      lanes_[l]->rebuild.order();
    }
    exchange_ghosts();
  }

  /// Instead of seed. @param shares  one a lane
  void restore(std::span<const CheckpointShare> shares) {
    for (std::size_t l = 0; l < lanes_.size(); ++l) {
      barchan::restore(lanes_[l]->brick, lanes_[l]->rebuild, placement(l), shares[l]);
      lanes_[l]->rebuild.order();
    }
    exchange_ghosts();
  }

  void rebuild(const std::vector<int>& cuts) {
    cuts_ = cuts;
    Outboxes out = outboxes();
    for (std::size_t l = 0; l < lanes_.size(); ++l) lanes_[l]->rebuild.begin(placement(l), out[l]);
    for (std::size_t l = 0; l < lanes_.size(); ++l) {
      for (const auto& message : arrivals(out, l)) lanes_[l]->rebuild.absorb(message);
    }
    for (auto& lane : lanes_) lane->rebuild.order();
    exchange_ghosts();
  }

  void step() {
    const StepFrame frame{world_->dt, {}, 0.0, step_++, world_->dt};
    for (auto& lane : lanes_) {
      lane->step.begin(frame);
      for (int c = 0; c < lane->brick.num_chunks(); ++c) lane->step.run_chunk(c);
    }
    for (auto& lane : lanes_) {
      for (const Side side : kSides) {
        if (lane->brick.band(side).exists) lane->step.finish_band(side);
      }
    }
    for (std::size_t l = 0; l < lanes_.size(); ++l) {
      const auto& links = lanes_[l]->brick.links;
      for (std::size_t n = 0; n < links.size(); ++n) {
        const std::size_t from = beside(l, links[n].side);
        const int back = link_of(from, opposite(links[n].side));
        std::vector<std::byte> message(halo_bytes(lanes_[from]->brick, back));
        pack_halo(lanes_[from]->brick, back, message);
        unpack_halo(lanes_[l]->brick, static_cast<int>(n), message);
      }
    }
  }

  /// Every contact's spring; a pair across a cut must be the same on both sides.
  [[nodiscard]] Springs springs(bool& sides_agree) const {
    Springs all;
    sides_agree = true;
    for (const auto& lane : lanes_) {
      const auto& store = lane->brick.store;
      const History& form = world_->history_form();
      const auto take = [&](const PairList& list, const PairBlock& block) {
        block.for_each_candidate(list, [&](std::size_t at, const double* numbers) {
          const std::int64_t a = store.id[static_cast<std::size_t>(list.i[at])],
                             b = store.id[static_cast<std::size_t>(list.j[at])];
          std::vector<double> s;
          for (int c = 0; c < form.length; ++c)
            s.push_back(form.sign(c, a > b) * numbers[c * kBatch]);
          if (std::ranges::all_of(s, [](double number) { return number == 0.0; })) return;
          const auto [it, is_new] = all.try_emplace(std::minmax(a, b), s);
          if (!is_new && it->second != s) sides_agree = false;
        });
      };
      for (const RowBlock& block : lane->brick.blocks) take(lane->brick.pairs, block);
      for (const Band& band : lane->brick.bands) {
        for (const PairBlock& block : band.blocks) take(band.across, block);
      }
    }
    return all;
  }

  [[nodiscard]] std::uint64_t digest() const {
    std::uint64_t sum = 0;
    for (const auto& lane : lanes_) sum += barchan::digest(lane->brick);
    return sum;
  }
  [[nodiscard]] std::size_t size() const { return lanes_.size(); }
  Lane<Dim>& operator[](std::size_t l) { return *lanes_[l]; }

 private:
  using Outboxes = std::vector<std::vector<std::vector<std::byte>>>;  ///< by lane and link

  [[nodiscard]] std::size_t beside(std::size_t l, Side side) const {
    return (l + (side == Side::Left ? lanes_.size() - 1 : 1)) % lanes_.size();
  }
  [[nodiscard]] int link_of(std::size_t l, Side side) const {
    const auto& links = lanes_[l]->brick.links;
    const auto at = std::ranges::find_if(links, [side](const auto& n) { return n.side == side; });
    return static_cast<int>(at - links.begin());
  }

  void place_band(std::size_t l) {
    const bool wraps = world_->grid.is_periodic(0) && lanes_.size() > 1;
    if (l > 0 || wraps) lanes_[l]->brick.add_link(Side::Left);
    if (l + 1 < lanes_.size() || wraps) lanes_[l]->brick.add_link(Side::Right);
  }

  [[nodiscard]] CellBox<Dim> box(std::size_t l) const {
    return box_of_slabs(world_->grid, cuts_[l], cuts_[l + 1]);
  }
  [[nodiscard]] Placement<Dim> placement(std::size_t l) const {
    Placement<Dim> at{box(l), {}};
    for (const auto& link : lanes_[l]->brick.links) at.beyond.push_back(box(beside(l, link.side)));
    return at;
  }

  [[nodiscard]] Outboxes outboxes() const {
    Outboxes out;
    for (const auto& lane : lanes_) out.emplace_back(lane->brick.links.size());
    return out;
  }
  /// What others have for this lane, by its links.
  [[nodiscard]] std::vector<std::span<const std::byte>> arrivals(const Outboxes& out,
                                                                 std::size_t l) const {
    std::vector<std::span<const std::byte>> messages;
    for (const auto& link : lanes_[l]->brick.links) {
      const std::size_t from = beside(l, link.side);
      messages.emplace_back(
          out[from][static_cast<std::size_t>(link_of(from, opposite(link.side)))]);
    }
    return messages;
  }

  void exchange_ghosts() {
    Outboxes out = outboxes();
    for (std::size_t l = 0; l < lanes_.size(); ++l) {
      for (std::size_t n = 0; n < out[l].size(); ++n)
        lanes_[l]->rebuild.pack_ghosts(static_cast<int>(n), out[l][n]);
      lanes_[l]->lists.list_owned();
    }
    for (std::size_t l = 0; l < lanes_.size(); ++l) {
      lanes_[l]->rebuild.take_ghosts(arrivals(out, l));
      lanes_[l]->rebuild.restore_history();
      lanes_[l]->lists.cut_chunks(64);
    }
  }

  World<Dim>* world_;
  std::vector<int> cuts_;
  std::int64_t step_ = 0;
  std::vector<std::unique_ptr<Lane<Dim>>> lanes_;
};

}  // namespace barchan::test
