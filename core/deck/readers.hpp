#pragma once

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
void read_material_names(const TableReader& root, DeckDraft& draft);
void read_bonds(const TableReader& root, DeckDraft& draft);
void read_walls(const TableReader& root, DeckDraft& draft);
void read_particles(const TableReader& root, DeckDraft& draft);
void read_contacts(const TableReader& root,
                   DeckDraft& draft);  ///< constants of every pair that can meet

/// Errors: InputError when two sources claim the same ground; a packing's holes are free ground.
void check_regions(const std::vector<ParticleSource>& sources, int dimension);

}  // namespace barchan::deck
