#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <barchan/core/kernels/pair_job.hpp>
#include <barchan/core/links/bond_break.hpp>
#include <barchan/core/model/model.hpp>
#include <barchan/core/particles/particle_store.hpp>
#include <barchan/core/search/bonded_pairs.hpp>
#include <barchan/core/search/cell_box.hpp>

namespace barchan {

/// A linking element from particle a (lower id) to b, with the forces it has built up.
///
///   2D  state | shear force, bending moment |
///   3D  state | shear force (3), bending moment (3), twisting moment |
template <int Dim>
struct Bond {
  static constexpr int kState = Dim == 2 ? 2 : 7;
  std::int64_t id_a = 0, id_b = 0;
  std::int32_t law = 0;
  double length = 0.0;  ///< unstressed [m]
  std::array<double, kState> state{};
};

/// A bond of a particle set, and back. @param at_start  its length where the data leave it open [m]
template <int Dim>
[[nodiscard]] Bond<Dim> bond_of(const BondData& data, double at_start);
template <int Dim>
[[nodiscard]] BondData data_of(const Bond<Dim>& bond);

/// The bonds of one lane: every bond with an owned end. A bond across a cut lives on both sides and
/// stays equal there.
///
/// Elastic beam after Potyondy & Cundall 2004, doi:10.1016/j.ijrmms.2004.09.011: normal force from
/// the length, shear and moments incremental, all with a dashpot. It breaks where
///
///   tension/A + |M|·R/I     > tensile strength   or
///   |shear|/A + |twist|·R/J > shear strength         (2D: no twist)
///
/// The force is computed from a to b on either side of a cut, so both sides agree to the bit.
template <int Dim>
class BondSet {
 public:
  /// Both ends owned, or the other end a ghost of that side.
  enum Group { Owned, Left, Right, kNumGroups };
  [[nodiscard]] static constexpr Group across(Side side) {
    return side == Side::Left ? Left : Right;
  }

  /// Takes a bond; if it is known, its state is replaced when `is_current`. @pre resolve() before
  /// the next step
  void add(const Bond<Dim>& bond, bool is_current = true);
  [[nodiscard]] const std::vector<Bond<Dim>>& bonds() const { return bonds_; }
  [[nodiscard]] bool empty() const { return bonds_.empty(); }

  /// Finds the ends, drops bonds with no owned end, and sorts each particle's bonds by partner.
  /// Throws RunError when an end is neither owned nor a ghost (the bond outgrew the halo).
  void resolve(ParticleStore<Dim>& store);

  /// A longer bond would reach past a band to rows that do not wait for ghosts. Refused on one rank
  /// too, where it would do no harm, so that a run does not depend on the number of ranks.
  /// Errors: RunError: a bond longer than a cell is wide. @pre resolve()
  void require_short(const Grid<Dim>& grid, const ParticleStore<Dim>& store) const;

  /// Forces of one group, kept until add_to_rows. @return bonds that broke now, by index
  std::span<const std::int32_t> compute(Group group, const ParticleStore<Dim>& store,
                                        std::span<const BondLaw> laws, const PeriodicBox& box,
                                        double dt);

  /// Adds the kept forces to the extra ones of rows [begin, end), each row's in order of the
  /// partner's id.
  void add_to_rows(ParticleStore<Dim>& store, std::int32_t begin, std::int32_t end) const;

  // The published exchange: one side of a cut computes, the other takes the forces. kExported
  // doubles a bond.
  static constexpr int kExported = 2 * Layout<Dim>::kForce + 1;
  [[nodiscard]] std::int32_t size(Group group) const {
    return group_begin_[static_cast<std::size_t>(group) + 1] -
           group_begin_[static_cast<std::size_t>(group)];
  }
  void export_group(Group group, std::vector<double>& out) const;
  void import_group(Group group, const ParticleStore<Dim>& store, const double* in);

  [[nodiscard]] std::int32_t end_a(std::int32_t bond) const {
    return ends_[static_cast<std::size_t>(bond)].first;
  }
  [[nodiscard]] std::int32_t end_b(std::int32_t bond) const {
    return ends_[static_cast<std::size_t>(bond)].second;
  }
  [[nodiscard]] bool is_broken(std::int32_t bond) const {
    return broken_[static_cast<std::size_t>(bond)];
  }
  /// As broken, but not counted: an end has left the domain. Until drop_broken.
  void cancel(std::int32_t bond) { broken_[static_cast<std::size_t>(bond)] = 1; }
  void drop_broken();
  /// From now on bonds that break are noted where their lower id is owned, or no longer.
  void keep_breaks(bool keeps) { keeps_breaks_ = keeps; }
  void begin_step(std::int64_t step) { step_ = step; }  ///< that breaks are noted with
  [[nodiscard]] std::vector<BondBreak> take_breaks() { return std::exchange(breaks_, {}); }
  /// Owned by their lower id, since the start.
  [[nodiscard]] std::int64_t num_broken() const { return num_broken_; }
  void set_num_broken(std::int64_t n) { num_broken_ = n; }
  /// Elastic energy of the bonds whose lower-id end is owned [J].
  [[nodiscard]] double energy(std::int32_t bond, const ParticleStore<Dim>& store,
                              std::span<const BondLaw> laws, const PeriodicBox& box) const;
  /// What a bond does to its first end.
  struct Pull {
    Vec3 towards = Vec3::Zero();  ///< from the first end to the second, unit
    double extension = 0.0;       ///< beyond the unstressed length [m]
    Vec3 force = Vec3::Zero();    ///< zero where it is about to break [N]
  };
  /// As the next forces will have it; changes no state.
  [[nodiscard]] Pull pull(std::int32_t bond, const ParticleStore<Dim>& store,
                          std::span<const BondLaw> laws, const PeriodicBox& box, double dt) const;
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Incidence {
    std::int32_t row, partner, bond;
    bool is_b;
  };
  using Record = std::array<double, Layout<Dim>::kForce>;

  void index_known();
  void count_break(std::int32_t bond);
  bool respond(std::int32_t bond, const ParticleStore<Dim>& store, const BondLaw& law,
               const PeriodicBox& box, double dt);

  std::vector<Bond<Dim>> bonds_;
  std::map<std::pair<std::int64_t, std::int64_t>, std::size_t> known_;  ///< by ids
  std::vector<std::pair<std::int32_t, std::int32_t>> ends_;
  std::vector<char> broken_;
  std::array<std::int32_t, kNumGroups + 1> group_begin_{};
  std::vector<Incidence> incidences_;  ///< sorted by row, then the partner's id
  std::vector<std::array<Record, 2>> force_;
  std::vector<std::int32_t> just_broken_;
  std::int64_t num_broken_ = 0;
  bool keeps_breaks_ = false;
  std::int64_t step_ = 0;
  std::vector<BondBreak> breaks_;
};

/// Stiffnesses of a bond [N/m, N·m/rad] and its section, from the law and the two radii.
struct BondSection {
  double radius, area, inertia, polar;  ///< R [m], A [m²], I, J [m⁴]; 2D: unit depth
  double kn, ks, bending, twisting;
};
template <int Dim>
BondSection bond_section(const BondLaw& law, double length, double radius_a, double radius_b);

extern template class BondSet<2>;
extern template class BondSet<3>;

}  // namespace barchan
