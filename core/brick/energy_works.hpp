#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <barchan/core/base/exact_sum.hpp>
#include <barchan/core/base/rows.hpp>
#include <barchan/core/laws/losses.hpp>
#include <barchan/core/particles/particle_store.hpp>

namespace barchan {

/// What has changed the kinetic energy since the account began [J]. Over a step a force F does the
/// work F·kick·(v + v')/2, of the velocities before and after: their sum is the change of kinetic
/// energy, whatever the step.
struct EnergyWorks {
  enum Part {
    Contacts,  ///< forces of pairs and walls on particles
    Bonds,     ///< forces of bonds on particles
    Gravity,
    Callers,       ///< forces and torques that a caller gives, velocities that it sets or adds
    LocalDamping,  ///< takes, so it is negative
    Departed,      ///< kinetic energy of particles that have left
    Dashpots,      ///< of what contacts have taken, what did so (Losses)
    Sliding,       ///< and springs across the normal
    Rolling,       ///< and springs against rolling and twisting
    StartKinetic,  ///< energies where the account began
    StartContacts,
    StartBonds,
    StartSliding,  ///< what such springs stored then
    StartRolling,
    StartWalls,  ///< what walls had done by then
    Begun,       ///< 1: there is an account
    kNumParts
  };
  std::array<ExactSum, kNumParts> sums;

  [[nodiscard]] ExactSum& operator[](Part part) { return sums[static_cast<std::size_t>(part)]; }
  [[nodiscard]] const ExactSum& operator[](Part part) const {
    return sums[static_cast<std::size_t>(part)];
  }
  /// Begins an account, on one brick of all.
  void begin(const ExactSum& kinetic, const ExactSum& elastic, const ExactSum& bonds_elastic,
             const ExactSum& walls);
  /// @param sliding, rolling  what such springs store
  void begin_springs(const ExactSum& sliding, const ExactSum& rolling) {
    (*this)[StartSliding] = sliding;
    (*this)[StartRolling] = rolling;
  }
  void add(const Losses& losses) {
    (*this)[Dashpots].add(losses.dashpots);
    (*this)[Sliding].add(losses.sliding);
    (*this)[Rolling].add(losses.rolling);
  }
  void add(const EnergyWorks& other) {
    for (std::size_t p = 0; p < kNumParts; ++p) sums[p].add(other.sums[p]);
  }
};

/// Books the works of a step on rows: begin(), then what acts on them part by part, then end(),
/// around the loop that advances them.
template <int Dim>
class WorkAccount {
 public:
  /// The velocities, and forces of pairs. @param rounder  that sums start from [N]
  void begin(const ParticleStore<Dim>& store, Rows rows, double rounder);
  /// What has been added to the extra forces of the rows since begin() or the last call belongs to
  /// `part`.
  void book(const ParticleStore<Dim>& store, EnergyWorks::Part part);
  /// @param kick  [s]
  /// @param gravity  [m/s²]
  void end(const ParticleStore<Dim>& store, double kick, std::span<const double, 3> gravity,
           bool is_damped, EnergyWorks& works);

 private:
  static constexpr std::size_t kForce = Layout<Dim>::kForce;
  static constexpr std::array<EnergyWorks::Part, 3> kForces{
      EnergyWorks::Contacts, EnergyWorks::Bonds, EnergyWorks::Callers};

  Rows rows_;
  std::vector<double> speeds_;  ///< before: as many a row as forces
  std::array<std::vector<double>, 3> forces_;
  std::vector<double> extra_;  ///< that has been booked
};

/// Kinetic energy of a row [J].
template <int Dim>
[[nodiscard]] double kinetic_energy(const ParticleStore<Dim>& store, std::int32_t row);

extern template class WorkAccount<2>;
extern template class WorkAccount<3>;

}  // namespace barchan
