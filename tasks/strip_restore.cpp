#include <barchan/tasks/strip.hpp>

// A strip from a checkpoint. Order, ghosts and lists come from the positions at the last rebuild,
// as they did then; after that the particles are put where they were.

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
  for (int l = 0; l < num_lanes(); ++l) {
    lane(l).put_back(shares[static_cast<std::size_t>(l)]);
    lane(l).forget_imbalance();
  }
  refresh_ghosts();
}

template <int Dim>
void Strip<Dim>::refresh_ghosts() {
  for (int l = 0; l < num_lanes(); ++l) {
    for (const Side side : kSides) {
      Bytes& out = posts_[static_cast<std::size_t>(l)].out[index_of(side)];
      out.resize(has_neighbour(l, side) ? lane(l).halo_bytes(in_core<Dim>(side)) : 0);
      if (!out.empty()) lane(l).pack_halo(in_core<Dim>(side), out);
    }
  }
  begin_bulk();
  if (exchange_) wait_bulk("ghosts");
  for (int l = 0; l < num_lanes(); ++l) {
    for (const Side side : kSides) {
      if (has_neighbour(l, side)) lane(l).unpack_halo(in_core<Dim>(side), bulk(l, side));
    }
  }
}

template void Strip<2>::refresh_ghosts();
template void Strip<3>::refresh_ghosts();
template void Strip<2>::restore(std::vector<int>, std::span<const CheckpointShare>);
template void Strip<3>::restore(std::vector<int>, std::span<const CheckpointShare>);

}  // namespace barchan
