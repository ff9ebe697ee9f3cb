#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <barchan/core/kernels/history_table.hpp>
#include <barchan/core/laws/laws.hpp>
#include <barchan/core/links/bonds.hpp>
#include <barchan/core/links/wall_shape.hpp>
#include <barchan/core/particles/layout.hpp>
#include <barchan/core/particles/row_record.hpp>
#include <barchan/core/search/cell_box.hpp>

// What bricks send each other at a rebuild, as bytes and back. Bytes that came in are held against
// the receiver's world before anyone works on them: any bytes are safe, whoever sent them.

namespace barchan {

template <int Dim>
struct World;

/// A contact on its way from old lists to new ones; its history as seen from the handle.
struct LooseContact {
  std::int32_t handle = 0;  ///< row: before order() a source row, in messages the migrant's number
  std::int64_t partner = 0;
};

template <int Dim>
struct WallRecord {
  std::int32_t number, wall;
  WallImage image;
  double history[kLongestHistory<Dim>];
};

template <int Dim>
struct BondRecord {
  Bond<Dim> bond;
  std::uint8_t is_current;  ///< the sender computes this bond; its state replaces the receiver's
};

/// Who leaves a brick over one link, with history and bonds. Contacts and walls name a migrant by
/// its place in `particles`.
template <int Dim>
struct Migration {
  std::vector<RowRecord<Dim>> particles;
  std::vector<double> carried;  ///< by them, World::num_carried each
  HistoryTable<LooseContact> contacts;
  std::vector<WallRecord<Dim>> walls;
  std::vector<BondRecord<Dim>> bonds;
};

/// Replaces `message`.
template <int Dim>
void encode(const Migration<Dim>& migration, std::vector<std::byte>& message);

/// Ghosts: all of these rows but what optional arrays have. Replaces `message`.
template <int Dim>
void encode_ghosts(const ParticleStore<Dim>& store, std::span<const Rows> runs,
                   std::vector<std::byte>& message);

/// Arrivals in a box of cells. Errors: RunError: damaged, or a particle that belongs elsewhere
template <int Dim>
[[nodiscard]] Migration<Dim> decode_migration(std::span<const std::byte> message,
                                              const World<Dim>& world, const CellBox<Dim>& box);

/// Ghosts of these cells, by cells. Errors: RunError.
template <int Dim>
[[nodiscard]] std::vector<RowRecord<Dim>> decode_ghosts(std::span<const std::byte> message,
                                                        const World<Dim>& world,
                                                        const CellRegion<Dim>& cells);

}  // namespace barchan
