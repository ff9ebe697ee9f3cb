#pragma once

#include <string>

#include <barchan/core/deck/table_reader.hpp>
#include <barchan/core/laws/laws.hpp>

namespace barchan::deck {

/// Sets what a [[material]] or [[pair]] says for the law at a place of the list.
/// Errors: InputError for keys of other laws, and for two keys where one may stand.
/// @return the first key that stands there; empty: none
std::string read_law_keys(int law, const TableReader& table, ContactConstants& to);

/// What contact.model says. Errors: InputError where the law is not for disks.
int read_law(const TableReader& contact);

}  // namespace barchan::deck
