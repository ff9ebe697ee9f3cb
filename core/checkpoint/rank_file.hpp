#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <barchan/core/checkpoint/check_share.hpp>

namespace barchan {

/// What the file of one rank says about itself.
struct RankFileHeader {
  std::int64_t step = 0;
  std::uint32_t dimension = 2;
  std::uint32_t rank = 0, num_ranks = 1;
};

/// By what a manifest knows a file.
struct RankFileSeal {
  std::uint64_t bytes = 0;
  std::uint64_t hash = 0;  ///< over header and table, and by the table over every block
};

/// One rank's part of a checkpoint, little-endian:
///
///   | header, 64 bytes | table, 32 bytes a block | block | block | …
///
///   header  | magic 8 | version 4 | dimension 4 | step 8 | rank 4 | ranks 4 | blocks 4 | 0 4 |
///           | file bytes 8 | 0 8 | hash 8 |
///   table   | column 4 | lane 4 | offset 8 | bytes 8 | hash 8 |      one row a block
///   block   | a column of a lane … | zeros up to a multiple of 64 bytes |
///
/// Hashes are XXH3 of 64 bits: the header's over header (its hash taken as zero) and table, a
/// block's over the block with its zeros. No byte is outside a hash.
///
/// Writes the file and waits for the disk. @param state  for rank 0, else empty. Errors: FileError
RankFileSeal write_rank_file(const std::string& path, const RankFileHeader& header,
                             std::span<const std::byte> state,
                             std::span<const CheckpointShare> shares);

/// A rank file in memory, verified as a whole: whoever has one can rely on it. Copes with any
/// bytes.
class RankFileView {
 public:
  /// @param file  its name for messages
  /// Errors: InputError: too short, another kind of file, a later version, damaged (which block).
  RankFileView(std::span<const std::byte> bytes, std::string file);

  [[nodiscard]] const RankFileHeader& header() const { return header_; }
  [[nodiscard]] RankFileSeal seal() const { return seal_; }
  [[nodiscard]] std::span<const std::byte> state() const;  ///< empty when there is none
  /// All lanes' columns, one lane after the other; totals are added up. Errors: InputError for
  /// columns that do not fit each other or `limits`.
  [[nodiscard]] CheckpointShare share(const ShareLimits& limits) const;

 private:
  struct Block {
    std::uint32_t column = 0, lane = 0;
    std::uint64_t offset = 0, bytes = 0, hash = 0;
  };
  [[noreturn]] void refuse(const std::string& what) const;
  std::uint32_t read_header();
  void read_table(std::uint32_t num_blocks);
  void check_block(std::size_t number) const;

  std::span<const std::byte> bytes_;
  std::string file_;
  RankFileHeader header_;
  RankFileSeal seal_;
  std::vector<Block> blocks_;
};

/// Reads a whole file of at most `most_bytes`. Errors: InputError.
[[nodiscard]] std::vector<std::byte> read_bytes(const std::string& path, std::uint64_t most_bytes);

}  // namespace barchan
