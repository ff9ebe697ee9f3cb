#include <barchan/tasks/particle_index.hpp>

#include <algorithm>

namespace barchan {

void ParticleIndex::make(std::uint64_t generation, std::vector<std::span<const std::int64_t>> ids) {
  generation_ = generation;
  ids_ = std::move(ids);
  sorted_.clear();
}

ParticlePlace ParticleIndex::next(ParticlePlace place) const {
  ++place.row;
  if (place.lane < 0) place = {0, 0};
  while (place.lane < static_cast<std::int32_t>(ids_.size()) &&
         place.row >= static_cast<std::int32_t>(ids_[static_cast<std::size_t>(place.lane)].size()))
    place = {place.lane + 1, 0};
  return place.lane < static_cast<std::int32_t>(ids_.size()) ? place : ParticlePlace{};
}

ParticleRun ParticleIndex::find(std::span<const std::int64_t> ids,
                                const ParticleRun& before) const {
  ParticlePlace last = before.first;
  last.row += static_cast<std::int32_t>(before.length) - 1;
  ParticlePlace place = next(last);
  if (place.lane < 0 || from(place).front() != ids.front()) place = search(ids.front());
  if (place.lane < 0) return {place, 1};
  const auto rows = from(place);
  const auto ends = std::mismatch(ids.begin(), ids.end(), rows.begin(), rows.end());
  return {place, static_cast<std::size_t>(ends.first - ids.begin())};
}

ParticlePlace ParticleIndex::search(std::int64_t id) const {
  if (sorted_.empty()) {
    for (ParticlePlace p = next({}); p.lane >= 0; p = next(p))
      sorted_.emplace_back(from(p).front(), p);
    std::sort(sorted_.begin(), sorted_.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
  }
  const auto found =
      std::lower_bound(sorted_.begin(), sorted_.end(), id,
                       [](const auto& entry, std::int64_t wanted) { return entry.first < wanted; });
  return found != sorted_.end() && found->first == id ? found->second : ParticlePlace{};
}

}  // namespace barchan
