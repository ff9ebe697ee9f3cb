#pragma once

#include <barchan/core/deck/table_reader.hpp>
#include <barchan/core/model/particle_source.hpp>

namespace barchan::deck {

/// bond_gap and bond_pairs of a [[particles]] table. Errors: InputError, also for both, or without
/// bond.
[[nodiscard]] BondLinks read_links(const TableReader& table);

}  // namespace barchan::deck
