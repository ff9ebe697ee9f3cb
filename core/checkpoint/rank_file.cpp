#include <barchan/core/checkpoint/rank_file.hpp>

#include <xxhash.h>

#include <array>
#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <new>

#include <barchan/core/base/exact_sum.hpp>
#include <barchan/core/checkpoint/durable.hpp>
#include <barchan/core/particles/share_columns.hpp>

namespace barchan {
namespace {

static_assert(std::endian::native == std::endian::little,
              "checkpoints are written as memory has them");

constexpr std::array<char, 8> kMagic{'b', 'a', 'r', 'c', 'h', 'a', 'n', '\n'};
constexpr std::uint32_t kVersion = 9;
constexpr std::size_t kAlign = 64;

struct DiskHeader {
  std::array<char, 8> magic;
  std::uint32_t version, dimension;
  std::int64_t step;
  std::uint32_t rank, num_ranks, num_blocks, zero;
  std::uint64_t file_bytes, reserved, hash;
};
struct DiskBlock {
  std::uint32_t column, lane;
  std::uint64_t offset, bytes, hash;
};
static_assert(sizeof(DiskHeader) == 64 && sizeof(DiskBlock) == 32);

constexpr std::array<std::byte, kAlign> kZeros{};

std::size_t padding(std::size_t bytes) {
  return (kAlign - bytes % kAlign) % kAlign;
}

struct Hasher {
  std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state{XXH3_createState(),
                                                                 &XXH3_freeState};
  Hasher() {
    if (!state) throw std::bad_alloc();
    XXH3_64bits_reset(state.get());
  }
  void add(std::span<const std::byte> bytes) {
    XXH3_64bits_update(state.get(), bytes.data(), bytes.size());
  }
  [[nodiscard]] std::uint64_t value() const { return XXH3_64bits_digest(state.get()); }
};

std::uint64_t hash_head(DiskHeader header, std::span<const std::byte> table) {
  header.hash = 0;
  Hasher hasher;
  hasher.add(std::as_bytes(std::span(&header, 1)));
  hasher.add(table);
  return hasher.value();
}

/// What is to be written, block by block.
class Plan {
 public:
  void add(CheckpointColumn column, std::uint32_t lane, std::span<const std::byte> bytes) {
    if (bytes.empty()) return;
    Hasher hasher;
    hasher.add(bytes);
    hasher.add(std::span(kZeros).first(padding(bytes.size())));
    table_.push_back({static_cast<std::uint32_t>(column), lane, 0, bytes.size(), hasher.value()});
    blocks_.push_back(bytes);
  }

  RankFileSeal write(const std::string& path, const RankFileHeader& about) {
    std::uint64_t end = sizeof(DiskHeader) + table_.size() * sizeof(DiskBlock);
    std::vector<std::span<const std::byte>> parts;
    const auto pad = [&](std::size_t bytes) {
      if (padding(bytes) > 0) parts.push_back(std::span(kZeros).first(padding(bytes)));
      end += padding(bytes);
    };
    pad(end);
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      table_[b].offset = end;
      parts.push_back(blocks_[b]);
      end += blocks_[b].size();
      pad(blocks_[b].size());
    }
    DiskHeader header{kMagic,
                      kVersion,
                      about.dimension,
                      about.step,
                      about.rank,
                      about.num_ranks,
                      static_cast<std::uint32_t>(table_.size()),
                      0,
                      end,
                      0,
                      0};
    const auto table = std::as_bytes(std::span(table_));
    header.hash = hash_head(header, table);
    parts.insert(parts.begin(), {std::as_bytes(std::span(&header, 1)), table});
    write_durably(path, parts);
    return {end, header.hash};
  }

 private:
  std::vector<DiskBlock> table_;
  std::vector<std::span<const std::byte>> blocks_;
};

template <class T>
void append(std::span<const std::byte> bytes, std::vector<T>& to) {
  const std::size_t at = to.size();
  to.resize(at + bytes.size() / sizeof(T));
  std::memcpy(to.data() + at, bytes.data(), bytes.size());
}

}  // namespace

RankFileSeal write_rank_file(const std::string& path, const RankFileHeader& header,
                             std::span<const std::byte> state,
                             std::span<const CheckpointShare> shares) {
  Plan plan;
  plan.add(CheckpointColumn::State, 0, state);
  for (std::size_t lane = 0; lane < shares.size(); ++lane) {
    for_each_column(shares[lane], [&](CheckpointColumn column, const auto& values) {
      plan.add(column, static_cast<std::uint32_t>(lane), std::as_bytes(std::span(values)));
    });
  }
  return plan.write(path, header);
}

RankFileView::RankFileView(std::span<const std::byte> bytes, std::string file)
    : bytes_(bytes), file_(std::move(file)) {
  read_table(read_header());
  for (std::size_t b = 0; b < blocks_.size(); ++b) check_block(b);
}

void RankFileView::refuse(const std::string& what) const {
  throw InputError(SourcePlace{file_, 0, 0}, what, "take another checkpoint");
}

std::uint32_t RankFileView::read_header() {
  DiskHeader header{};
  if (bytes_.size() < sizeof header) refuse("too short for a checkpoint file");
  std::memcpy(&header, bytes_.data(), sizeof header);
  if (header.magic != kMagic) refuse("not a checkpoint file");
  const std::size_t room = bytes_.size() - sizeof header;
  if (header.num_blocks > room / sizeof(DiskBlock))
    refuse("the table of blocks is cut off or damaged");
  const auto table = bytes_.subspan(sizeof header, header.num_blocks * sizeof(DiskBlock));
  if (hash_head(header, table) != header.hash)
    refuse("the header is damaged: its checksum differs");
  if (header.version != kVersion) {
    refuse("format version " + std::to_string(header.version) +
           ", and this program reads version " + std::to_string(kVersion));
  }
  if (header.file_bytes != bytes_.size()) {
    refuse("has " + std::to_string(bytes_.size()) + " bytes instead of " +
           std::to_string(header.file_bytes));
  }
  if (header.dimension != 2 && header.dimension != 3)
    refuse("dimension " + std::to_string(header.dimension));
  header_ = {header.step, header.dimension, header.rank, header.num_ranks};
  seal_ = {header.file_bytes, header.hash};
  return header.num_blocks;
}

void RankFileView::read_table(std::uint32_t num_blocks) {
  std::uint64_t end = sizeof(DiskHeader) + num_blocks * sizeof(DiskBlock);
  for (const std::uint64_t stop = end + padding(end); end < stop; ++end) {
    if (end >= bytes_.size() || bytes_[end] != std::byte{0})
      refuse("the gap after the table is damaged");
  }
  for (std::uint32_t b = 0; b < num_blocks; ++b) {
    DiskBlock block{};
    std::memcpy(&block, bytes_.data() + sizeof(DiskHeader) + b * sizeof block, sizeof block);
    const bool fits = block.offset == end && block.bytes <= bytes_.size() - end &&
                      padding(block.bytes) <= bytes_.size() - end - block.bytes;
    if (!fits) refuse("block " + std::to_string(b) + " lies outside the file");
    blocks_.push_back({block.column, block.lane, block.offset, block.bytes, block.hash});
    end += block.bytes + padding(block.bytes);
  }
  if (end != bytes_.size()) refuse("bytes after the last block");
}

void RankFileView::check_block(std::size_t number) const {
  const Block& block = blocks_[number];
  const auto whole = bytes_.subspan(block.offset, block.bytes + padding(block.bytes));
  if (XXH3_64bits(whole.data(), whole.size()) == block.hash) return;
  refuse("block " + std::to_string(number) + " (" +
         name_of(static_cast<CheckpointColumn>(block.column)) + " of lane " +
         std::to_string(block.lane) + ") is damaged: its checksum differs");
}

std::span<const std::byte> RankFileView::state() const {
  for (const Block& block : blocks_) {
    if (block.column == static_cast<std::uint32_t>(CheckpointColumn::State))
      return bytes_.subspan(block.offset, block.bytes);
  }
  return {};
}

CheckpointShare RankFileView::share(const ShareLimits& limits) const {
  CheckpointShare share;
  std::vector<std::int64_t> totals(num_totals(limits.num_walls), 0);
  for (const Block& block : blocks_) {
    const auto bytes = bytes_.subspan(block.offset, block.bytes);
    for_each_column(share, [&](CheckpointColumn column, auto& values) {
      if (static_cast<std::uint32_t>(column) != block.column) return;
      if (bytes.size() % sizeof(values[0]) != 0)
        refuse("the column " + name_of(column) + " ends within a value");
      append(bytes, values);
    });
    if (share.totals.empty()) continue;
    if (share.totals.size() != totals.size())
      refuse("the column totals does not fit the deck's walls");
    for (std::size_t t = 0; t < totals.size(); ++t) {
      totals[t] = std::bit_cast<std::int64_t>(std::bit_cast<std::uint64_t>(totals[t]) +
                                              std::bit_cast<std::uint64_t>(share.totals[t]));
    }
    share.totals.clear();
  }
  share.totals = std::move(totals);
  check_share(share, limits, file_);
  return share;
}

std::vector<std::byte> read_bytes(const std::string& path, std::uint64_t most_bytes) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(SourcePlace{path, 0, 0}, "cannot be read: " + why, "take another checkpoint");
  };
  const std::unique_ptr<std::FILE, decltype(&std::fclose)> file(std::fopen(path.c_str(), "rb"),
                                                                &std::fclose);
  if (!file) refuse(std::strerror(errno));
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) refuse("not a regular file");
  const std::uint64_t size = std::filesystem::file_size(path, error);
  if (error) refuse(error.message());
  if (size > most_bytes)
    refuse("larger than it should be, which is " + std::to_string(most_bytes) + " bytes");
  std::vector<std::byte> bytes;
  try {
    bytes.resize(size);
  } catch (const std::bad_alloc&) {
    refuse("does not fit in memory");
  }
  bytes.resize(std::fread(bytes.data(), 1, size, file.get()));
  if (std::ferror(file.get()) != 0) refuse(std::strerror(errno));
  return bytes;
}

}  // namespace barchan
