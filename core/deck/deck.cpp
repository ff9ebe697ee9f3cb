#include <barchan/core/deck/deck.hpp>

#include <filesystem>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include <barchan/core/deck/canonical.hpp>
#include <barchan/core/deck/overrides.hpp>
#include <barchan/core/deck/readers.hpp>
#include <barchan/core/deck/table_reader.hpp>
#include <barchan/core/model/validate.hpp>

namespace barchan {

namespace {

constexpr std::size_t kMaxDeckBytes = std::size_t{64} << 20;

/// The text of a file, at most one byte more than a deck may have.
std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text;
  std::vector<char> block(std::size_t{1} << 16);
  while (file && text.size() <= kMaxDeckBytes) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    text.append(block.data(), static_cast<std::size_t>(file.gcount()));
  }
  std::error_code ignored;
  if (!file.is_open() || file.bad() || std::filesystem::is_directory(path, ignored)) {
    throw InputError({path, 0, 0}, "cannot read this deck",
                     "give the path of a readable TOML file");
  }
  return text;
}

/// Other tables need the dimension before they can be read.
int read_dimension(const deck::Node& root) {
  const deck::TableReader reader(root, 2, "deck");
  const std::int64_t dimension = reader.integer("dimension");
  if (dimension != 2 && dimension != 3) {
    reader.fail("dimension", fmt::format("dimension = {} is out of range", dimension),
                "write 2 for disks or 3 for spheres");
  }
  return static_cast<int>(dimension);
}

}  // namespace

Deck read_deck(const std::string& path, std::span<const DeckOverride> overrides) {
  return parse_deck(read_text(path), path, overrides);
}

Deck parse_deck(std::string_view text, const std::string& file_name,
                std::span<const DeckOverride> overrides) {
  if (text.size() > kMaxDeckBytes) {
    throw InputError({file_name, 0, 0}, "a deck of more than 64 MiB",
                     "move its particles into a file of their own");
  }
  deck::Node root = deck::parse_toml(text, file_name);
  if (root.line == 0) root.line = root.column = 1;
  for (const DeckOverride& change : overrides) deck::apply_override(root, change);

  deck::DeckDraft draft;
  draft.deck.model.deck_file = file_name;
  draft.deck.model.dimension = read_dimension(root);
  draft.folder = std::filesystem::path(file_name).parent_path().string();
  const deck::TableReader reader(root, draft.deck.model.dimension, "deck");
  deck::read_run_tables(reader, draft);
  deck::read_stages(reader, draft);
  deck::read_heat(reader, draft);
  deck::read_material_names(reader, draft);
  deck::read_bonds(reader, draft);
  deck::read_walls(reader, draft);
  deck::read_particles(reader, draft);
  deck::read_contacts(reader, draft);
  deck::check_heat(draft);
  deck::check_regions(draft.deck.sources, draft.deck.model.dimension);
  if (const auto fault = find_fault(draft.deck.model))
    throw InputError(deck::place_of(root, fault->key), fault->what, fault->remedy);
  draft.deck.keys = deck::canonical_keys(root);
  return std::move(draft.deck);
}

}  // namespace barchan
