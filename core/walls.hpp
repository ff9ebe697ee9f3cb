#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <span>
#include <vector>

#include <barchan/core/contact_law.hpp>
#include <barchan/core/exact_sum.hpp>
#include <barchan/core/kernels/pair_job.hpp>
#include <barchan/core/law_table.hpp>
#include <barchan/core/model.hpp>
#include <barchan/core/particle_store.hpp>
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
};

/// Order-free sums over the contacts of one wall.
struct WallSums {
  ExactSum force[3], torque[3];  ///< of the particles on the wall [N], about its point [N·m]
  ExactSum work;                 ///< of the wall on the particles [J]
  void add(const WallSums& other);
  void add_force(const WallState& state, const Vec3& at, const Vec3& force_on_wall);
};

/// A particle near a wall, with the tangential spring of their contact.
template <int Dim>
struct WallContact {
  std::int32_t row = 0;
  std::int32_t wall = 0;
  double spring[Layout<Dim>::kSprings] = {};
};

template <int Dim>
[[nodiscard]] bool has_spring(const WallContact<Dim>& contact) {
  return std::any_of(std::begin(contact.spring), std::end(contact.spring),
                     [](double s) { return s != 0.0; });
}

/// A wall is a particle of radius 0 and infinite mass at its point nearest to the particle.
template <int Dim>
class WallContacts {
 public:
  /// Lists rows within `skin` of an active wall, ordered by row, then wall.
  void search(const ParticleStore<Dim>& store, std::span<const WallSpec> specs,
              std::span<const WallState> states, double skin);

  std::vector<WallContact<Dim>>& list() { return list_; }
  [[nodiscard]] const std::vector<WallContact<Dim>>& list() const { return list_; }

  struct Frame {
    std::span<const WallSpec> specs;
    std::span<const WallState> states;
    const LawTable* laws = nullptr;
    double dt = 0.0;
  };
  /// Adds wall forces to rows [begin, end). @param sums  one a wall; force and work of walls that
  /// move are added up
  void add_to_rows(ParticleStore<Dim>& store, const Frame& frame, std::span<WallSums> sums,
                   std::int32_t begin, std::int32_t end);
  /// Force and torque on all walls as the next step will find them; changes no spring.
  void measure(const ParticleStore<Dim>& store, const Frame& frame, std::span<WallSums> sums) const;

  /// Distance from a position to a wall and the vector to its nearest point.
  static double nearest(const WallSpec& spec, const WallState& state, const double* x,
                        double* to_wall);

 private:
  struct Push {
    PairForce<simd::Scalar, Dim> on_particle;
    Vec3 at, on_wall;
  };
  static Push push(const ParticleStore<Dim>& store, const Frame& frame, WallContact<Dim>& contact);

  std::vector<WallContact<Dim>> list_;
};

extern template class WallContacts<2>;
extern template class WallContacts<3>;

}  // namespace barchan
