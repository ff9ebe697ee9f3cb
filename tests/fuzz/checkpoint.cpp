#include <xxhash.h>

#include <cstring>
#include <vector>

#include <barchan/core/checkpoint/manifest.hpp>
#include <barchan/core/checkpoint/rank_file.hpp>
#include <barchan/core/checkpoint/state.hpp>

#include "support/input.hpp"
#include "support/lanes.hpp"

// A checkpoint behind its checksums: they are put right, so that what they would have stopped
// reaches the readers. The first byte says which file: manifest, rank file in 2D or 3D (with the
// share that a lane is restored from), state.

namespace barchan::fuzz {
namespace {

constexpr std::size_t kHeader = 64, kBlock = 32, kHashAt = 56, kNumBlocksAt = 32, kFileBytesAt = 40;

template <class T>
T load(std::span<const std::byte> bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

void store(std::span<std::byte> bytes, std::size_t at, std::uint64_t value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

/// The file with the hashes and the length that it should have.
std::vector<std::byte> sealed(std::span<const std::byte> data) {
  std::vector<std::byte> bytes(data.begin(), data.end());
  if (bytes.size() < kHeader) return bytes;
  store(bytes, kFileBytesAt, bytes.size());
  const auto num_blocks = load<std::uint32_t>(bytes, kNumBlocksAt);
  const std::size_t room = (bytes.size() - kHeader) / kBlock;
  if (num_blocks > room) return bytes;
  for (std::size_t b = 0; b < num_blocks; ++b) {
    const std::size_t entry = kHeader + b * kBlock;
    const auto offset = load<std::uint64_t>(bytes, entry + 8),
               length = load<std::uint64_t>(bytes, entry + 16);
    if (offset > bytes.size() || length > bytes.size() - offset) continue;
    const std::size_t whole = std::min<std::size_t>((length + 63) / 64 * 64, bytes.size() - offset);
    store(bytes, entry + 24, XXH3_64bits(bytes.data() + offset, whole));
  }
  store(bytes, kHashAt, 0);
  store(bytes, kHashAt, XXH3_64bits(bytes.data(), kHeader + num_blocks * kBlock));
  return bytes;
}

void read_manifest(std::string_view body) {
  std::string text(body);
  char hash[17];
  std::snprintf(hash, sizeof hash, "%016llx",
                static_cast<unsigned long long>(XXH3_64bits(text.data(), text.size())));
  text += ",\n\"xxh3\": \"" + std::string(hash) + "\"}\n";
  const Manifest manifest = parse_manifest(text, "manifest.json");
  (void)manifest_text(manifest);
}

void read_state(std::span<const std::byte> bytes, const Model& model) {
  const CheckpointState state = decode_state(bytes, "rank_00000.bin");
  check_same_model(state, model, "rank_00000.bin");
}

/// What a restart does with a share: one lane takes all.
template <int Dim>
void read_rank_file(std::span<const std::byte> bytes) {
  const std::vector<std::byte> file = sealed(bytes);
  const RankFileView view(file, "rank_00000.bin");
  Sample<Dim> sample;
  if (!view.state().empty()) read_state(view.state(), sample.model());
  const ShareLimits limits{Dim, 2, sample.world().walls.size(), sample.world().bond_laws.size()};
  const CheckpointShare share = view.share(limits);
  sample.restore(share);
}

void read(std::uint8_t kind, std::span<const std::byte> bytes) {
  if (kind == 'm')
    read_manifest(text_of(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()));
  if (kind == 's') read_state(bytes, Sample<2>().model());
  if (kind == '2') read_rank_file<2>(bytes);
  if (kind == '3') read_rank_file<3>(bytes);
}

}  // namespace
}  // namespace barchan::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace barchan::fuzz;
  if (size == 0) return 0;
  expect_run_error(
      [&] { expect_input_error([&] { read(data[0], bytes_of(data + 1, size - 1)); }); });
  return 0;
}
