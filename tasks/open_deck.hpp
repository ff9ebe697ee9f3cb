#pragma once

#include <string>
#include <vector>

#include <barchan/comm/base/communicator.hpp>
#include <barchan/core/deck/deck.hpp>
#include <barchan/tasks/run_options.hpp>
#include <barchan/tasks/simulation.hpp>

namespace barchan {

/// A deck as a caller has it.
struct DeckSource {
  std::string path;                          ///< of a file; empty: the text is the deck
  std::string text;                          ///< TOML
  std::vector<DeckOverride> overrides = {};  ///< as `--set`
};

/// From a deck to a simulation, as `barchan run` does it. The same deck on every rank. Collective.
/// @param checkpoint  to continue from: its folder, or one of several, of which the newest complete
/// one is taken; empty: from the start
/// Errors: InputError, the same on every rank
[[nodiscard]] Simulation open_deck(const DeckSource& source, Communicator communicator,
                                   const RunOptions& options = {},
                                   const std::string& checkpoint = "");

}  // namespace barchan
