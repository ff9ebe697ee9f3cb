// [heat], and what it needs of other tables.
#include <algorithm>
#include <variant>

#include <fmt/format.h>

#include <barchan/core/deck/readers.hpp>

namespace barchan::deck {

void read_heat(const TableReader& root, DeckDraft& draft) {
  if (!root.has("heat")) return;
  const TableReader table(*root.table("heat"), root.dimension(), "[heat]");
  draft.deck.model.heat = {true, table.number("temperature"), table.boolean("dissipation")};
}

std::optional<double> heat_number(const TableReader& table, std::string_view key,
                                  const Model& model) {
  const auto number = table.optional_number(key);
  if (number && !model.heat.is_on)
    table.fail(key, fmt::format("{} is given, but the deck has no table [heat]", key),
               fmt::format("add [heat], which gives particles temperatures, or leave {} out", key));
  return number;
}

std::vector<bool> made_into_particles(const Deck& deck) {
  std::vector<bool> made(deck.model.materials.size(), false);
  for (const ParticleSource& source : deck.sources) {
    if (const auto* list = std::get_if<ListSource>(&source.kind)) {
      for (const ParticleData& particle : list->particles) made[particle.type] = true;
    } else if (source.material) {
      made[*source.material] = true;
    } else {
      made.assign(made.size(), true);
    }
  }
  return made;
}

void check_heat(const DeckDraft& draft) {
  const Model& model = draft.deck.model;
  if (!model.heat.is_on) return;
  const std::vector<bool> made = made_into_particles(draft.deck);
  const auto refuse = [&](std::size_t material, const char* key, const char* unit,
                          const std::string& who) {
    throw InputError(
        draft.materials.place(static_cast<int>(material)),
        fmt::format("'{}' has no {}, and {}", model.materials[material].name, key, who),
        fmt::format("add {} in {} to the material, or leave [heat] out", key, unit));
  };
  for (std::size_t a = 0; a < made.size(); ++a) {
    const Material& material = model.materials[a];
    const std::string who = "particles that have temperatures are made of it";
    if (made[a] && material.conductivity == 0.0) refuse(a, "conductivity", "W/(m·K)", who);
    if (made[a] && material.heat_capacity == 0.0) refuse(a, "heat_capacity", "J/(kg·K)", who);
  }
  for (const WallSpec& wall : model.walls) {
    const auto a = static_cast<std::size_t>(wall.material);
    if (wall.temperature && model.materials[a].conductivity == 0.0)
      refuse(a, "conductivity", "W/(m·K)",
             fmt::format("wall '{}' of it keeps a temperature", wall.name));
  }
}

}  // namespace barchan::deck
