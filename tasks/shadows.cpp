#include <barchan/tasks/shadows.hpp>

#include <algorithm>

#include <barchan/core/base/clock.hpp>
#include <barchan/core/brick/diagnose.hpp>
#include <barchan/core/brick/halo.hpp>
#include <barchan/core/brick/measure.hpp>

namespace barchan {

template <int Dim>
Shadows<Dim>::Shadows(const World<Dim>& world, Side side, int depth)
    : world_(world),
      side_(side),
      told_(static_cast<std::size_t>(depth) + 2, 0),
      to_inside_(told_.size()),
      to_outside_(told_.size()),
      ghosts_(static_cast<std::size_t>(depth)),
      records_(static_cast<std::size_t>(depth) + 2) {
  for (int n = 1; n <= depth; ++n) {
    Brick<Dim>& brick = slices_.emplace_back(world).lane.brick;
    // All rows are beside cuts, and complete together.
    brick.form = CutForm::Bricks;
    brick.is_shadow = true;
    for (const Side at : kSides) brick.add_link(at);
  }
}

/// Slabs count from the cut on; beyond the last shadow lies the rest of the owner.
template <int Dim>
Placement<Dim> Shadows<Dim>::placement(const Lane<Dim>& own, int link, int n) const {
  const CellBox<Dim>& owner = own.brick.links[static_cast<std::size_t>(link)].beyond;
  const auto slab = [&](int number) {
    if (number == 0) return own.brick.box;
    CellBox<Dim> box = owner;
    int &lo = box.lo[0], &hi = box.hi[0];
    const bool is_rest = number > depth();
    if (side_ == Side::Right) {
      lo += number - 1;
      if (!is_rest) hi = lo + 1;
    } else {
      hi -= number - 1;
      if (!is_rest) lo = hi - 1;
    }
    return box;
  };
  Placement<Dim> at{slab(n), {slab(n - 1), slab(n + 1)}};
  if (side_ == Side::Left) std::swap(at.beyond[0], at.beyond[1]);
  return at;
}

template <int Dim>
void Shadows<Dim>::fill(const Lane<Dim>& own, int link, ByteReader& message) {
  const auto slabs = unpack_slabs(message, depth());
  for (int n = 1; n <= depth(); ++n) {
    Slice& to = slice(n);
    to.world = bare(world_);
    to.lane.rebuild.begin_shadow(placement(own, link, n));
    to.lane.rebuild.absorb(slabs[static_cast<std::size_t>(n) - 1]);
    to.lane.rebuild.order();
    to.lane.rebuild.pack_ghosts(inner_link(), ghosts_[static_cast<std::size_t>(n) - 1]);
  }
  Bytes from_inside;
  own.rebuild.pack_ghosts(link, from_inside);
  for (int n = 1; n <= depth(); ++n) {
    Lane<Dim>& lane = slice(n).lane;
    const Bytes& from_outside = n == depth() ? slabs.back() : ghosts_[static_cast<std::size_t>(n)];
    std::array<std::span<const std::byte>, 2> messages{from_inside, from_outside};
    if (side_ == Side::Left) std::swap(messages[0], messages[1]);
    lane.lists.list_owned();
    lane.rebuild.take_ghosts(messages);
    lane.rebuild.restore_history();
    lane.lists.cut_chunks(std::int64_t{1} << 60);
    lane.rebuild.pack_ghosts(outer_link(), from_inside);
  }
  std::fill(told_.begin(), told_.end(), 0);
  begun_ = 0;
}

template <int Dim>
std::vector<std::uint64_t> Shadows<Dim>::digests() const {
  std::vector<std::uint64_t> sums;
  for (const Slice& slice : slices_) sums.push_back(digest(slice.lane.brick));
  return sums;
}

template <int Dim>
void Shadows<Dim>::begin_step(const StepFrame& frame) {
  Record& record = records_[static_cast<std::size_t>(begun_++) % records_.size()];
  record.frame = frame;
  record.walls = world_.walls;
  record.dt = world_.dt;
  record.last_dt = world_.last_dt;
}

template <int Dim>
void Shadows<Dim>::take_message(std::span<const std::byte> message) {
  const std::int64_t step = ++told_.back();
  to_inside_.back()[static_cast<std::size_t>(step % 2)].assign(message.begin(), message.end());
}

template <int Dim>
bool Shadows<Dim>::may_step(int n) {
  const std::int64_t k = told(n);
  if (must_stop(slice(n).lane.brick)) return false;  // as its owner
  return k < begun_ && told(n - 1) >= k && told(n + 1) >= k;
}

/// From the outside in, so that one message may move all of them on.
template <int Dim>
bool Shadows<Dim>::advance() {
  bool has_any = false;
  for (int n = depth(); n >= 1; --n) {
    if (!may_step(n)) continue;
    step(n);
    has_any = true;
  }
  return has_any;
}

template <int Dim>
void Shadows<Dim>::pack(const Brick<Dim>& brick, int link, Bytes& frame) {
  frame.resize(halo_bytes(brick, link));
  pack_halo(brick, link, frame);
}

template <int Dim>
void Shadows<Dim>::step(int n) {
  const std::int64_t begin = now_ns(), k = told(n);
  Slice& of = slice(n);
  Lane<Dim>& lane = of.lane;
  const Record& record = records_[static_cast<std::size_t>(k) % records_.size()];
  of.world.walls = record.walls;
  of.world.dt = record.dt;
  of.world.last_dt = record.last_dt;
  press_plates(of, record.frame);
  lane.step.begin(record.frame);
  for (int c = 0; c < lane.brick.num_chunks(); ++c) lane.step.run_chunk(c);
  const auto at = static_cast<std::size_t>(n);
  const auto now = static_cast<std::size_t>(k % 2), next = 1 - now;
  if (k > 0) {  // ghosts of the rebuild are those of its step
    unpack_halo(lane.brick, inner_link(), to_outside_[at - 1][now]);
    unpack_halo(lane.brick, outer_link(), to_inside_[at + 1][now]);
  }
  for (const Side side : kSides) lane.step.finish_band(side);
  pack(lane.brick, inner_link(), to_inside_[at][next]);
  if (n < depth()) pack(lane.brick, outer_link(), to_outside_[at][next]);
  ++told(n);
  work_ns_ += now_ns() - begin;
}

/// Rows feel loaded plates by what is kept of their contacts; sums are the owner's.
template <int Dim>
void Shadows<Dim>::press_plates(Slice& of, const StepFrame& frame) {
  const auto& specs = of.world.wall_specs;
  if (std::ranges::none_of(specs, &WallSpec::is_loaded)) return;
  pressed_.assign(specs.size(), WallSums());
  of.lane.step.press_plates(frame, pressed_);
}

template <int Dim>
void Shadows<Dim>::tell(const Brick<Dim>& own, int link) {
  pack(own, link, to_outside_[0][static_cast<std::size_t>((told_[0] + 1) % 2)]);
  ++told_[0];
}

template <int Dim>
std::size_t Shadows<Dim>::bytes() const {
  std::size_t n = 0;
  for (const Slice& slice : slices_) n += slice.lane.bytes();
  return n;
}

template class Shadows<2>;
template class Shadows<3>;

}  // namespace barchan
