#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace barchan {

struct ParticlePlace {
  std::int32_t lane = -1, row = -1;  ///< lane < 0: not on this rank
};

/// Particles whose rows follow each other.
struct ParticleRun {
  ParticlePlace first;
  std::size_t length = 0;
};

/// Where the particles of this rank are: id → lane and row.
class ParticleIndex {
 public:
  [[nodiscard]] bool is_of(std::uint64_t generation) const { return generation_ == generation; }
  /// @param ids  of every lane, of the rows that it owns; they stay while the index serves
  void make(std::uint64_t generation, std::vector<std::span<const std::int64_t>> ids);
  /// The longest beginning of `ids` that are rows one after the other: whoever asks in the order of
  /// rows needs no search. @param before  the run that ended here
  [[nodiscard]] ParticleRun find(std::span<const std::int64_t> ids,
                                 const ParticleRun& before = {}) const;

 private:
  [[nodiscard]] ParticlePlace next(ParticlePlace place) const;
  [[nodiscard]] ParticlePlace search(std::int64_t id) const;
  [[nodiscard]] std::span<const std::int64_t> from(ParticlePlace place) const {
    return ids_[static_cast<std::size_t>(place.lane)].subspan(static_cast<std::size_t>(place.row));
  }

  std::uint64_t generation_ = ~std::uint64_t{0};
  std::vector<std::span<const std::int64_t>> ids_;
  mutable std::vector<std::pair<std::int64_t, ParticlePlace>> sorted_;  ///< made when first asked
};

}  // namespace barchan
