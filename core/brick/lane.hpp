#pragma once

#include <cstddef>

#include <barchan/core/brick/brick.hpp>
#include <barchan/core/brick/lists.hpp>
#include <barchan/core/brick/rebuild.hpp>
#include <barchan/core/brick/step.hpp>

namespace barchan {

template <int Dim>
[[nodiscard]] std::size_t bytes_of(const Brick<Dim>& brick) {
  std::size_t total = brick.store.bytes() + brick.pairs.bytes() + brick.bonds.bytes() +
                      brick.walls.bytes() + sizeof(std::int64_t) * brick.row_begin.capacity() +
                      brick.cells.bytes() + sizeof(RowBlock) * brick.blocks.capacity();
  for (const Band& band : brick.bands) total += band.across.bytes() + band.planes.bytes();
  return total;
}

/// A lane is to a thread what a strip is to a rank: a brick, and what works on it. All of it is
/// single-threaded and touches this brick only.
template <int Dim>
struct Lane {
  Brick<Dim> brick;
  Lists<Dim> lists;
  Rebuild<Dim> rebuild;
  Step<Dim> step;

  explicit Lane(World<Dim>& world)
      : brick(world), lists(brick), rebuild(brick, lists), step(brick, lists) {}
  Lane(const Lane&) = delete;
  Lane& operator=(const Lane&) = delete;

  [[nodiscard]] std::size_t bytes() const {
    return bytes_of(brick) + lists.bytes() + rebuild.bytes();
  }
};

}  // namespace barchan
