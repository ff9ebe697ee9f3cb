#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <span>
#include <tuple>
#include <vector>

#include <barchan/core/base/exact_sum.hpp>
#include <barchan/core/base/rows.hpp>
#include <barchan/core/kernels/law_table.hpp>
#include <barchan/core/laws/contact.hpp>
#include <barchan/core/links/wall_shape.hpp>
#include <barchan/core/model/model.hpp>
#include <barchan/core/particles/particle_store.hpp>
#include <barchan/core/search/grid.hpp>
#include <barchan/core/simd/scalar.hpp>

namespace barchan {

/// Where a wall is, the same on every rank. Work is what the wall has done on the particles.
struct WallState {
  Vec3 point = Vec3::Zero();     ///< [m]
  Vec3 velocity = Vec3::Zero();  ///< [m/s]
  bool is_active = true;
  Vec3 force = Vec3::Zero();   ///< of the particles on the wall, as last reduced [N]
  Vec3 torque = Vec3::Zero();  ///< about `point` [N·m]
  double work = 0.0;           ///< [J]
  double heat_flow = 0.0;      ///< into particles, as last reduced [W]
};

/// Order-free sums over the contacts of one wall.
struct WallSums {
  ExactSum force[3], torque[3];  ///< of the particles on the wall [N], about its point [N·m]
  ExactSum work;                 ///< of the wall on the particles [J]
  ExactSum heat_flow;            ///< from the wall into the particles [W]
  void add(const WallSums& other);
};

/// A particle that a wall pushes or holds.
struct WallPush {
  std::int32_t row = 0, wall = 0;
  Vec3 to_wall = Vec3::Zero();  ///< from the particle's centre [m]
  double overlap = 0.0;         ///< [m]
  Vec3 force = Vec3::Zero();    ///< on the particle [N]
};

/// What a particle loses at a wall in a step.
struct WallLoss {
  std::int32_t row = 0;
  Losses losses;
};

/// A particle near an image of a wall, with the history of their contact.
template <int Dim>
struct WallContact {
  std::int32_t row = 0;
  std::int32_t wall = 0;
  WallImage image{};
  double history[kLongestHistory<Dim>] = {};
};

/// What the order of a list goes by, and what finds a contact again after a rebuild.
template <int Dim>
[[nodiscard]] auto key_of(const WallContact<Dim>& contact) {
  return std::tuple(contact.row, contact.wall, contact.image);
}

template <int Dim>
[[nodiscard]] bool has_history(const WallContact<Dim>& contact) {
  return std::any_of(std::begin(contact.history), std::end(contact.history),
                     [](double number) { return number != 0.0; });
}

/// The walls of a run, as they are now.
template <int Dim>
struct WallView {
  std::span<const WallSpec> specs;
  std::span<const WallShape<Dim>> shapes;
  std::span<const WallState> states;
  double range = 0.0;  ///< beyond touch, up to which contacts may hold [m]
};

/// A wall is a particle of radius 0 at its point nearest to the particle, and of infinite mass
/// unless it is a loaded plate. One that is touched by several images is touched several times.
///
/// Walls that meet have one surface. Where the foot on a wall's rim lies on another wall, too, a
/// particle feels the other wall, or one of the two where both have the same foot:
///
///        o                      o
///     ───┴──+───────         ───┴──+         of two plates that meet at + this particle feels the
///                                   ╲        left one alone
///
/// The contact that is not felt keeps the history of the one that is, so that a particle takes it
/// over the joint.
///
/// The force of a step k on a loaded plate moves the plate in that step. So its contacts come first
/// (`press`), and while the sum over all ranks is on its way, all rows take up what was kept:
///
///     press(k) precedes add_to_rows(k);   press(k) … sum … plates move precedes press(k+1)
template <int Dim>
class WallContacts {
 public:
  /// Lists rows that lack less than `beyond` to touch an active wall, by row, wall, image. A fixed
  /// particle touches loaded plates only, where alone its force is of use, and what gives it heat.
  void search(const ParticleStore<Dim>& store, const WallView<Dim>& walls, double beyond);
  /// Before positions of these rows are wrapped into the box: images as seen from there.
  void foresee_wrap(const ParticleStore<Dim>& store, const Grid<Dim>& grid,
                    std::span<const WallShape<Dim>> shapes, Rows rows);

  [[nodiscard]] std::span<WallContact<Dim>> list() { return list_; }
  [[nodiscard]] std::span<const WallContact<Dim>> list() const { return list_; }
  [[nodiscard]] std::size_t bytes() const {
    return list_.capacity() * sizeof(WallContact<Dim>) + loaded_.capacity() * sizeof(std::size_t) +
           kept_.capacity() * sizeof(Push);
  }

  /// Does the particle feel this contact of the list, or that with a wall which meets this one?
  [[nodiscard]] bool is_felt(const ParticleStore<Dim>& store, const WallView<Dim>& walls,
                             std::size_t place) const {
    return felt_instead(store, walls, place, foot_of(store, walls, list_[place])) == nullptr;
  }

  struct Frame {
    WallView<Dim> walls;
    const LawTable* laws = nullptr;
    double dt = 0.0;
    double kick = 0.0;  ///< as in LossTimes, for losses
    std::vector<WallLoss>* losses =
        nullptr;  ///< where add_to_rows writes them; null: not asked for
  };
  /// Computes contacts with loaded plates, keeps their forces for add_to_rows, and adds the forces
  /// on the plates to `sums`, one a wall.
  void press(const ParticleStore<Dim>& store, const Frame& frame, std::span<WallSums> sums);
  /// Adds wall forces to the extra ones of rows [begin, end). @pre press(), where there are loaded
  /// plates
  /// @param sums  one a wall; the work of walls with a given velocity is added up
  void add_to_rows(ParticleStore<Dim>& store, const Frame& frame, std::span<WallSums> sums,
                   std::int32_t begin, std::int32_t end);
  /// Force and torque on all walls as the next step will find them; changes no history.
  void measure(const ParticleStore<Dim>& store, const Frame& frame, std::span<WallSums> sums) const;
  /// The same, contact by contact.
  [[nodiscard]] std::vector<WallPush> pushes(const ParticleStore<Dim>& store,
                                             const Frame& frame) const;

 private:
  using Force = PairForce<simd::Scalar, Dim>;  ///< on the particle
  struct Push {
    Force on_particle;
    Vec3 on_wall;
    Losses losses{};  ///< where the frame asks for them
  };
  /// Of the contact at this place of the list, whose history is carried on in `contact`.
  Push push(const ParticleStore<Dim>& store, const Frame& frame, std::size_t place,
            WallContact<Dim>& contact) const;
  static WallFoot foot_of(const ParticleStore<Dim>& store, const WallView<Dim>& walls,
                          const WallContact<Dim>& contact);
  const WallContact<Dim>* felt_instead(const ParticleStore<Dim>& store, const WallView<Dim>& walls,
                                       std::size_t place, const WallFoot& foot) const;

  std::vector<WallContact<Dim>> list_;
  std::vector<std::size_t> loaded_;  ///< places in the list of contacts with loaded plates
  std::vector<Push> kept_;           ///< of each of them
};

extern template class WallContacts<2>;
extern template class WallContacts<3>;

}  // namespace barchan
