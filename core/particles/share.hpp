#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace barchan {

/// The columns of a checkpoint's rank files; the numbers are part of the format.
enum class CheckpointColumn : std::uint32_t {
  State = 1,    ///< what all ranks share, encoded; in the file of rank 0 (state.hpp)
  Totals = 2,   ///< broken bonds, digits of works of walls and of energies; a sum over all lanes
  Outruns = 3,  ///< what the next check may still have to tell

  // from 16 on: fields of particles (fields.hpp)

  Carried = 31,  ///< fields of the caller's own; which there are is part of the state

  ContactIds = 32,
  ContactSprings = 33,
  WallContactIds = 34,
  WallContactWalls = 35,
  WallContactSprings = 36,
  BondIds = 37,
  BondLaws = 38,
  BondLengths = 39,
  BondStates = 40,
  WallContactImages = 41,
};

/// The name of a column as messages say it.
[[nodiscard]] std::string name_of(CheckpointColumn column);

/// What a checkpoint keeps of one lane, column by column. Every contact, bond and particle of a run
/// is in one share.
struct CheckpointShare {
  std::vector<std::int64_t> ids;
  std::vector<double> positions, velocities;  ///< [m], [m/s]; Dim each
  std::vector<double> surface_speeds;         ///< u = r·omega [m/s]; 1 or 3 each
  std::vector<double> radii, inverse_masses;  ///< [m], [1/kg]
  std::vector<double> densities;              ///< [kg/m³], 2D [kg/m²]
  std::vector<std::uint8_t> types, flags;
  std::vector<double> externals;  ///< force records, or none at all
  /// [K]; none at all where heat is off. A temperature is the sum of the two (heat.hpp).
  std::vector<double> temperatures, temperature_remainders;
  std::vector<double> carried;  ///< fields of the caller's own, as rows have them

  std::vector<std::int64_t> contact_ids;  ///< two each, of pairs whose history is not zero
  std::vector<double> contact_springs;    ///< histories, as seen from the first
  std::vector<std::int64_t> wall_contact_ids;
  std::vector<std::int32_t> wall_contact_walls;
  std::vector<std::int32_t> wall_contact_images;  ///< three each
  std::vector<double> wall_contact_springs;
  std::vector<std::int64_t> bond_ids;  ///< two each, the lower one first; intact bonds
  std::vector<std::int32_t> bond_laws;
  std::vector<double> bond_lengths, bond_states;

  std::vector<std::int64_t> totals;
  std::vector<double> outruns;  ///< one a lane: squared travel with its lists over half the skin's

  void clear();
};

}  // namespace barchan
