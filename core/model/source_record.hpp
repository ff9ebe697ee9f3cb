#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

// What a checkpoint remembers of the tables of particles that its run began with, so that a restart
// with other particles is refused and what differs is named.

namespace barchan {

struct ParticleSet;
struct ParticleSource;

/// One key of a [[particles]] table: its path in the table, and its value in canonical words.
struct SourceKey {
  std::string key, value;
  bool operator==(const SourceKey&) const = default;
};

/// One [[particles]] table.
struct SourceRecord {
  std::string kind;             ///< lattice, file, ...
  std::int64_t line = 0;        ///< of the table in the deck, 0 when unknown; not compared
  std::vector<SourceKey> keys;  ///< as the deck and --set give them
  std::uint64_t hash = 0;       ///< over the particles that it made, and the bonds that begin there
};

/// Records of all sources, with the hashes of what they made. @param begins  see make_particles
[[nodiscard]] std::vector<SourceRecord> make_records(std::span<const ParticleSource> sources,
                                                     const ParticleSet& made,
                                                     std::span<const std::size_t> begins);

/// What differs between the sources of a checkpoint and those of a deck, in words; empty where both
/// make the same particles. Keys without effect on the particles may differ. Generators may round
/// otherwise on another machine, so other particles from equal keys differ only when they come from
/// a file. Empty lists are not compared: particles of a caller's own have no records.
[[nodiscard]] std::string source_differences(std::span<const SourceRecord> saved,
                                             std::span<const SourceRecord> now);

}  // namespace barchan
