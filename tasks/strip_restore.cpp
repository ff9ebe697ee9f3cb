#include <barchan/tasks/strip.hpp>

// A strip from a checkpoint. Order, ghosts and lists come from the positions at the last rebuild,
// as they did then; after that the particles are put where they were.

namespace barchan {
namespace {

constexpr std::array<Side, 2> kSides{Side::Left, Side::Right};
constexpr std::size_t at(Side side) {
  return static_cast<std::size_t>(side);
}

template <int Dim>
typename Lane<Dim>::Side in_core(Side side) {
  return side == Side::Left ? Lane<Dim>::Left : Lane<Dim>::Right;
}

}  // namespace

template <int Dim>
void Strip<Dim>::restore(std::vector<int> cuts, std::span<const CheckpointShare> shares) {
  cuts_ = std::move(cuts);
  for (int l = 0; l < num_lanes(); ++l) {
    const auto place = static_cast<std::size_t>(first_lane() + l);
    lane(l).restore(cuts_[place], cuts_[place + 1], shares[static_cast<std::size_t>(l)]);
    lane(l).order();
  }
  exchange_ghosts([this](const std::function<void(int)>& body) {
    for (int l = 0; l < num_lanes(); ++l) body(l);
  });
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
      Bytes& out = posts_[static_cast<std::size_t>(l)].out[at(side)];
      out.resize(has_neighbour(l, side) ? lane(l).halo_bytes(in_core<Dim>(side)) : 0);
      if (!out.empty()) lane(l).pack_halo(in_core<Dim>(side), out);
    }
  }
  if (exchange_) {
    const Bytes none;
    exchange_->begin_bulk(neighbours_.has(Side::Left) ? posts_.front().out[at(Side::Left)] : none,
                          neighbours_.has(Side::Right) ? posts_.back().out[at(Side::Right)] : none);
    wait_bulk("ghosts");
  }
  for (int l = 0; l < num_lanes(); ++l) {
    for (const Side side : kSides) {
      if (!has_neighbour(l, side)) continue;
      const int n = num_lanes(), other = (l + (side == Side::Left ? n - 1 : 1)) % n;
      const bool is_remote = is_outer(l, side) && neighbours_.has(side);
      lane(l).unpack_halo(in_core<Dim>(side),
                          is_remote
                              ? exchange_->bulk(side)
                              : posts_[static_cast<std::size_t>(other)].out[at(opposite(side))]);
    }
  }
}

template void Strip<2>::refresh_ghosts();
template void Strip<3>::refresh_ghosts();
template void Strip<2>::restore(std::vector<int>, std::span<const CheckpointShare>);
template void Strip<3>::restore(std::vector<int>, std::span<const CheckpointShare>);

}  // namespace barchan
