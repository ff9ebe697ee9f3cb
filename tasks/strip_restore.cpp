#include <barchan/tasks/strip.hpp>

namespace barchan {

template <int Dim>
void Strip<Dim>::restore(std::vector<int> cuts, std::span<const CheckpointShare> shares) {
  cuts_ = std::move(cuts);
  for (int l = 0; l < num_lanes(); ++l) {
    const auto place = static_cast<std::size_t>(first_lane() + l);
    lane(l).restore(cuts_[place], cuts_[place + 1], shares[static_cast<std::size_t>(l)]);
    lane(l).order();
  }
  exchange_ghosts(one_by_one());
  for (const auto& lane : lanes_) lane->forget_imbalance();
}

template void Strip<2>::restore(std::vector<int>, std::span<const CheckpointShare>);
template void Strip<3>::restore(std::vector<int>, std::span<const CheckpointShare>);

}  // namespace barchan
