#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <barchan/core/checkpoint/rank_file.hpp>
#include <barchan/core/model/source_record.hpp>

namespace barchan {

/// What a manifest says about the file of one rank.
struct ManifestFile {
  RankFileSeal seal;
  double lo = 0.0, hi = 0.0;  ///< where its particles lie along the strip axis, within the box [m]
  std::int64_t particles = 0, contacts = 0, wall_contacts = 0, bonds = 0;
};

/// The list of contents of a checkpoint. It is written last: a checkpoint without it does not
/// exist.
///
/// JSON; its last member is the XXH3 of all bytes before it, so that not one of them can change
/// unnoticed.
struct Manifest {
  std::int64_t step = 0;
  double time = 0.0;  ///< [s]
  int dimension = 2;
  std::string title;
  std::vector<ManifestFile> files;    ///< by rank
  std::vector<SourceRecord> sources;  ///< of the particles that the run began with; may be empty

  [[nodiscard]] ManifestFile totals() const;
};

[[nodiscard]] std::string manifest_text(const Manifest& manifest);
/// @param file  its name for messages. Errors: InputError: damaged, a later version, contradictory
[[nodiscard]] Manifest parse_manifest(const std::string& text, const std::string& file);

/// `rank_00000.bin`
[[nodiscard]] std::string rank_file_name(std::size_t rank);
inline constexpr const char* kManifestName = "manifest.json";

}  // namespace barchan
