#include <barchan/tasks/growth_watch.hpp>

#include <fmt/format.h>

namespace barchan {

template <int Dim>
void GrowthWatch::look(RunParts<Dim>& run, std::int64_t step, Notes& notes) {
  std::size_t buffer = 0;
  const auto tell = [&](std::size_t size, bool is_mine, const auto& describe) {
    if (buffer == sizes_.size()) sizes_.push_back(size);  // at the start
    std::size_t& known = sizes_[buffer++];
    if (size < known + known / 4 + 1) return;
    if (is_mine) notes.add(step, fmt::format("{} grow from {} to {}", describe(), known, size));
    known = size;
  };
  for (int l = 0; l < run.strip.num_lanes(); ++l) {
    Lane<Dim>& lane = run.strip.lane(l);
    const auto named = [&](const char* what) {
      return [&run, l, what] {
        return fmt::format("rank {}, lane {}: {}", run.communicator.rank(), l, what);
      };
    };
    std::size_t candidates = lane.brick.pairs.i.capacity();
    for (const Side side : kSides) candidates += lane.brick.band(side).across.i.capacity();
    tell(lane.brick.store.id.capacity(), true, named("rows of particles and ghosts"));
    tell(candidates, true, named("candidate pairs"));
  }
  if (run.strip.exchange() == nullptr) return;
  const ExchangeStats stats = run.strip.exchange()->stats();  // equal on all ranks
  tell(stats.halo_capacity, run.communicator.is_root(),
       [] { return "all ranks: bytes of a halo slot"; });
  tell(stats.bulk_capacity, run.communicator.is_root(),
       [] { return "all ranks: bytes of a slot for migration"; });
}

template void GrowthWatch::look(RunParts<2>&, std::int64_t, Notes&);
template void GrowthWatch::look(RunParts<3>&, std::int64_t, Notes&);

}  // namespace barchan
