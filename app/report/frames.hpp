#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <barchan/app/loaded_deck.hpp>
#include <barchan/core/io/vtp.hpp>

// Particles at one time, as far as a page shows them.

namespace barchan::app {

/// Of more bonds none is shown.
inline constexpr std::size_t kMostBonds = 200000;

struct Grain {
  std::int64_t id;
  std::array<float, 3> position;
  float radius, speed, spin;
  std::uint8_t type, rank;
};

/// What is there at a time.
struct Frame {
  std::int64_t step = 0;
  double time = 0.0;
  std::vector<Grain> grains;  ///< by id
  std::vector<float> bonds;   ///< x y z of both ends
  bool hides_bonds = false;   ///< there are more than a page takes
};

/// A snapshot. @param folder  of the files that the entries name; @param bonds  null: none
/// Errors: InputError.
[[nodiscard]] Frame read_frame(const std::string& folder, const PvdEntry& particles,
                               const PvdEntry* bonds);

/// What a deck makes.
[[nodiscard]] Frame frame_of(const LoadedDeck& loaded);

}  // namespace barchan::app
