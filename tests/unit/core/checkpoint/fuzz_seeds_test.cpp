#include <gtest/gtest.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <barchan/core/checkpoint/rank_file.hpp>
#include <barchan/core/checkpoint/state.hpp>

// Seeds of the fuzzers that the readers take: one that is refused at its version leads nowhere.

namespace barchan {
namespace {

/// Without the first byte, which tells the fuzzer what follows.
std::vector<std::byte> seed(const std::string& name) {
  const auto path = std::filesystem::path(BARCHAN_TREE) / "tests/fuzz/corpus/checkpoint" / name;
  std::vector<std::byte> bytes = read_bytes(path.string(), 1 << 20);
  bytes.erase(bytes.begin());
  return bytes;
}

TEST(FuzzSeeds, OfRankFilesAreOfThisVersion) {
  for (const int dimension : {2, 3}) {
    const auto bytes = seed(dimension == 2 ? "rank_2d" : "rank_3d");
    const RankFileView view(bytes, "rank_00000.bin");
    const CheckpointShare share =
        view.share({dimension, 2, 2, 1});  // materials, walls, laws of bonds of the fuzzer's sample
    EXPECT_FALSE(share.ids.empty());
    EXPECT_FALSE(share.contact_ids.empty());
    EXPECT_FALSE(share.bond_ids.empty());
  }
}

TEST(FuzzSeeds, OfTheStateAreOfThisVersion) {
  EXPECT_EQ(decode_state(seed("state"), "rank_00000.bin").walls.size(), 2U);
}

}  // namespace
}  // namespace barchan
