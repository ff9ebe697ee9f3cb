#include <barchan/core/checkpoint/state.hpp>
#include <barchan/core/deck/deck.hpp>
#include <barchan/core/generators/make_particles.hpp>
#include <barchan/tasks/stability.hpp>

#include "support/input.hpp"

// A deck from text to the checks before a run: TOML, overrides, model, particles, limits of the
// time step. An input is lines of `--set key=value`, if any, then the deck.

namespace barchan::fuzz {
namespace {

constexpr double kMostGrains = 300.0, kMostPacked = 8.0;  ///< more would only take time

double volume(const Box& box, int dimension) {
  double v = 1.0;
  for (int axis = 0; axis < dimension; ++axis) v *= box.hi[axis] - box.lo[axis];
  return v;
}

double num_grains(const LatticeSource& s, int dimension) {
  double n = 1.0;
  for (int axis = 0; axis < dimension; ++axis)
    n *= 1.0 + 2.0 * (s.region.hi[axis] - s.region.lo[axis]) / s.spacing;
  return n;
}

/// Whether the particles are few and need no file.
bool is_small(const ParticleSource& source, int dimension) {
  if (const auto* s = std::get_if<LatticeSource>(&source.kind))
    return num_grains(*s, dimension) <= kMostGrains;
  if (const auto* s = std::get_if<PackingSource>(&source.kind)) {
    const double smallest = 2.0 * s->sizes.min_radius();
    return volume(s->region, dimension) <= kMostPacked * std::pow(smallest, dimension);
  }
  if (const auto* s = std::get_if<RingSource>(&source.kind))
    return static_cast<double>(s->count) <= kMostGrains;
  return std::holds_alternative<ListSource>(source.kind);
}

std::vector<DeckOverride> take_overrides(std::string_view& text) {
  constexpr std::string_view kOption = "--set ";
  std::vector<DeckOverride> overrides;
  while (text.starts_with(kOption) && overrides.size() < 4) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    overrides.push_back(parse_override(text.substr(kOption.size(), end - kOption.size())));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return overrides;
}

void read(std::string_view text) {
  const std::vector<DeckOverride> overrides = take_overrides(text);
  const Deck deck = parse_deck(text, "deck.toml", overrides);
  (void)fingerprint(deck.model);
  for (const ParticleSource& source : deck.sources) {
    if (!is_small(source, deck.model.dimension)) return;
  }
  const ParticleSet particles = make_particles(deck.model, deck.sources);
  check_particles(deck.model, particles);
  check_time_step(deck.model, step_limits(deck.model, particles));
}

}  // namespace
}  // namespace barchan::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace barchan::fuzz;
  expect_input_error([&] { read(text_of(data, size)); });
  return 0;
}
