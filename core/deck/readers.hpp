#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include <barchan/core/deck/deck.hpp>
#include <barchan/core/deck/name_index.hpp>
#include <barchan/core/deck/table_reader.hpp>

// One function per kind of table. They run in the order in which they stand here: later ones look
// up the names and boxes of earlier ones.

namespace barchan::deck {

/// A deck that is being read.
struct DeckDraft {
  Deck deck;
  NameIndex materials{"material"};
  NameIndex bonds{"bond"};
  NameIndex stages{"stage"};
  NameIndex walls{"wall"};
  std::string folder;  ///< of the deck
};

void read_run_tables(const TableReader& root,
                     DeckDraft& draft);  ///< title .. domain, time, search, output, checkpoint
void read_stages(const TableReader& root, DeckDraft& draft);
void read_heat(const TableReader& root, DeckDraft& draft);
void read_material_names(const TableReader& root, DeckDraft& draft);
void read_bonds(const TableReader& root, DeckDraft& draft);
void read_walls(const TableReader& root, DeckDraft& draft);
void read_particles(const TableReader& root, DeckDraft& draft);
void read_contacts(const TableReader& root,
                   DeckDraft& draft);  ///< constants of every pair that can meet

/// A temperature or another number of heat, if it is there. Errors: InputError where heat is off
[[nodiscard]] std::optional<double> heat_number(const TableReader& table, std::string_view key,
                                                const Model& model);
/// Errors: InputError for a material that lacks what heat needs of it.
void check_heat(const DeckDraft& draft);
/// By material: whether particles may be made of it.
[[nodiscard]] std::vector<bool> made_into_particles(const Deck& deck);

/// Errors: InputError when two sources claim the same ground; a packing's holes are free ground.
void check_regions(const std::vector<ParticleSource>& sources, int dimension);

}  // namespace barchan::deck
