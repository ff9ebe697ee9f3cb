#include <barchan/app/loaded_deck.hpp>

#include <barchan/core/generators/check_walls.hpp>
#include <barchan/core/generators/make_particles.hpp>

namespace barchan::app {

LoadedDeck load_deck(const std::string& path, const std::vector<std::string>& settings) {
  std::vector<DeckOverride> overrides;
  for (const std::string& setting : settings) overrides.push_back(parse_override(setting));
  LoadedDeck loaded;
  loaded.deck = read_deck(path, overrides);
  loaded.particles = make_particles(loaded.deck.model, loaded.deck.sources, loaded.begins);
  check_particles(loaded.deck.model, loaded.particles, [&](std::size_t index) {
    return place_of_particle(loaded.deck.sources, loaded.begins, index);
  });
  check_walls(loaded.deck.model, loaded.particles);
  loaded.deck.model.sources = make_records(loaded.deck.sources, loaded.particles, loaded.begins);
  return loaded;
}

}  // namespace barchan::app
