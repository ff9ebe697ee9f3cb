#include <barchan/tasks/open_deck.hpp>

#include <cstddef>
#include <utility>

#include <barchan/core/base/error.hpp>
#include <barchan/core/generators/make_particles.hpp>
#include <barchan/core/model/source_record.hpp>
#include <barchan/tasks/agree.hpp>
#include <barchan/tasks/checkpoint_load.hpp>

namespace barchan {

Simulation open_deck(const DeckSource& source, Communicator communicator, const RunOptions& options,
                     const std::string& checkpoint) {
  Deck deck;
  ParticleSet particles;
  agree(communicator, [&] {
    deck = source.path.empty() ? parse_deck(source.text, "deck", source.overrides)
                               : read_deck(source.path, source.overrides);
    std::vector<std::size_t> begins;
    particles = make_particles(deck.model, deck.sources, begins);
    deck.model.sources = make_records(deck.sources, particles, begins);
  });
  if (checkpoint.empty()) return {deck.model, particles, std::move(communicator), options};
  const auto found = find_checkpoint(communicator, checkpoint);
  if (!found)
    throw InputError("there is no checkpoint in " + checkpoint, "name a folder that holds one");
  return Simulation::restore(deck.model, found->path, std::move(communicator), options);
}

}  // namespace barchan
