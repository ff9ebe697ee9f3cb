#pragma once

#include <barchan/app/loaded_deck.hpp>

namespace barchan::app {

/// Prints the contact constants of every pair of materials that can meet, with its restitution: as
/// given, as mixed, or as its dashpot makes it between these particles.
void print_contacts(const LoadedDeck& loaded);

}  // namespace barchan::app
