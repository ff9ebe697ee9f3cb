#pragma once

#include <string>

#include <barchan/core/deck/table_reader.hpp>
#include <barchan/core/laws/laws.hpp>

namespace barchan::deck {

/// What a deck chooses in [contact].
struct LawChoice {
  int law = 0;         ///< place in the list of laws
  bool rolls = false;  ///< keys of rolling have a place
  bool twists = false;
  bool is_by_radius = false;  ///< linear springs that follow from moduli and radii
  Adhesion adhesion = Adhesion::None;
  bool attracts = false;  ///< jkr
};

/// Sets what a [[material]] or [[pair]] says for a law.
/// Errors: InputError for keys of other laws, and for two keys where one may stand.
/// @return the first key that stands there; empty: none
std::string read_law_keys(const LawChoice& choice, const TableReader& table, ContactConstants& to);

/// Errors: InputError where there is no such law in so many dimensions.
LawChoice read_law(const TableReader& contact);

}  // namespace barchan::deck
