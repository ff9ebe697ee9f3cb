#pragma once

#include <string>
#include <vector>

#include <barchan/core/deck/deck.hpp>
#include <barchan/core/model/model.hpp>

namespace barchan::app {

/// A deck and the particles that it makes.
struct LoadedDeck {
  Deck deck;
  ParticleSet particles;
  std::vector<std::size_t> begins;  ///< of each source; see make_particles
};

/// Reads a deck and makes its particles. Local. Errors: InputError.
[[nodiscard]] LoadedDeck load_deck(const std::string& path,
                                   const std::vector<std::string>& settings);

}  // namespace barchan::app
