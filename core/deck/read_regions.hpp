#pragma once

#include <barchan/core/deck/table_reader.hpp>
#include <barchan/core/model/particle_source.hpp>

namespace barchan::deck {

LatticeSource read_lattice(const TableReader& table, const Model& model);
PackingSource read_packing(const TableReader& table, const Model& model);

}  // namespace barchan::deck
