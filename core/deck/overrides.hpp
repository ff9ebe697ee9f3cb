#pragma once

#include <barchan/core/deck/deck.hpp>
#include <barchan/core/deck/node.hpp>

namespace barchan::deck {

/// Sets one value in the tree, as if the deck said so; tables on the way appear where they are
/// missing. Errors: InputError, placed at the override.
void apply_override(Node& root, const DeckOverride& change);

}  // namespace barchan::deck
