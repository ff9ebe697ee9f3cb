#include <sys/resource.h>
#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

#include <gtest/gtest.h>

#include <barchan/core/base/exact_sum.hpp>
#include <barchan/core/checkpoint/check_share.hpp>
#include <barchan/core/checkpoint/checkpoint_folder.hpp>
#include <barchan/core/checkpoint/durable.hpp>
#include <barchan/core/checkpoint/state.hpp>

#include <support/temporary_folder.hpp>

namespace fs = std::filesystem;

namespace barchan {
namespace {

/// In memory where that can be had: the tests write thousands of files.
struct Folder : test::TemporaryFolder {
  Folder() : TemporaryFolder(test::fast_parent()) {}
};

constexpr ShareLimits kLimits{2, 3, 2, 1};

/// A share of a 2D run with two walls, three materials and one bond law.
CheckpointShare some_share(int num_particles, std::int64_t first_id) {
  CheckpointShare s;
  std::mt19937_64 random(static_cast<std::uint64_t>(first_id));
  const auto number = [&random] { return static_cast<double>(random() % 1000) * 0.001 - 0.3; };
  for (int p = 0; p < num_particles; ++p) {
    s.ids.push_back(first_id + p);
    for (auto* column : {&s.positions, &s.velocities})
      column->insert(column->end(), {number(), number()});
    s.surface_speeds.push_back(number());
    s.radii.push_back(0.05);
    s.inverse_masses.push_back(1.0);
    s.densities.push_back(number());
    s.types.push_back(static_cast<std::uint8_t>(p % 3));
    s.flags.push_back(0);
  }
  for (int p = 0; p + 1 < num_particles; p += 2) {
    s.contact_ids.insert(s.contact_ids.end(), {first_id + p, first_id + p + 1});
    s.contact_springs.push_back(number());
  }
  s.wall_contact_ids = {first_id};
  s.wall_contact_walls = {1};
  s.wall_contact_images = {-1, 0, 2};
  s.wall_contact_springs = {-0.0};
  s.bond_ids = {first_id, first_id + 1};
  s.bond_laws = {0};
  s.bond_lengths = {0.1};
  s.bond_states = {1.0, 2.0};
  s.totals.assign(num_totals(2), 3);
  return s;
}

CheckpointState some_state() {
  CheckpointState s;
  s.step = 500;
  s.skin = 0.01;
  s.reach = 0.13;
  s.start_particles = s.num_particles = 40;
  s.grain = 0x1p-40;
  s.look.step = 496;
  s.look.outside = 7;
  s.walls.resize(2);
  s.walls[1].point[1] = 0.75;
  s.fingerprint = {1, 2, 3};
  return s;
}

ManifestFile listed(const RankFileSeal& seal, std::span<const CheckpointShare> shares) {
  ManifestFile f{seal, 0, 7, 0, 0, 0, 0};
  for (const CheckpointShare& s : shares) {
    f.particles += static_cast<std::int64_t>(s.ids.size());
    f.contacts += static_cast<std::int64_t>(s.contact_ids.size() / 2);
  }
  return f;
}

/// A complete checkpoint of two ranks. @return its folder
std::string write_some(const std::string& path, std::int64_t step = 500) {
  const CheckpointFolder folder(path);
  folder.begin(step);
  Manifest manifest{step, 0.1, 2, "a run", {}, {}};
  for (std::uint32_t rank = 0; rank < 2; ++rank) {
    const std::vector<CheckpointShare> shares{some_share(12, 100 * rank + 1),
                                              some_share(8, 100 * rank + 51)};
    const auto state = rank == 0 ? encode(some_state()) : std::vector<std::byte>{};
    const std::string file = folder.unfinished(step) + "/" + rank_file_name(rank);
    manifest.files.push_back(
        listed(write_rank_file(file, {step, 2, rank, 2}, state, shares), shares));
  }
  folder.commit(manifest);
  return folder.complete(step);
}

TEST(Checkpoint, KnowsFieldsOfCallers) {
  CheckpointState state = some_state();
  CallerFields fields;
  fields.add("dose", 1);
  fields.add("path", 3);
  state.fields = fields.saved();
  const CheckpointState read = decode_state(encode(state), "file");
  EXPECT_EQ(num_carried(read), 4);
  ASSERT_TRUE(fields.restore(read.fields));
  EXPECT_EQ(fields.find("path")->at, 1);
  CheckpointShare share = some_share(5, 1);
  ShareLimits limits = kLimits;
  limits.num_carried = num_carried(read);
  EXPECT_THROW(check_share(share, limits, "file"), InputError);
  share.carried.assign(20, 0.5);
  EXPECT_NO_THROW(check_share(share, limits, "file"));
  EXPECT_THROW(check_share(share, kLimits, "file"), InputError);
  for (const std::int32_t components : {0, -1, 1 << 30}) {
    state.fields[1].components = components;
    EXPECT_THROW((void)decode_state(encode(state), "file"), InputError) << components;
  }
  state.fields[1] = state.fields[0];  // a name that comes twice
  EXPECT_THROW((void)decode_state(encode(state), "file"), InputError);
}

/// Reads all of a checkpoint, as a restart does.
std::vector<CheckpointShare> read_all(const std::string& checkpoint) {
  const Manifest manifest = read_manifest(checkpoint);
  std::vector<CheckpointShare> shares;
  for (std::size_t rank = 0; rank < manifest.files.size(); ++rank) {
    const std::string file = checkpoint + "/" + rank_file_name(rank);
    const auto bytes = read_bytes(file, manifest.files[rank].seal.bytes);
    const RankFileView view(bytes, file);
    if (view.seal().hash != manifest.files[rank].seal.hash) throw InputError("another file", "");
    if (rank == 0) (void)decode_state(view.state(), file);
    shares.push_back(view.share(kLimits));
  }
  return shares;
}

std::vector<std::byte> bytes_of(const std::string& path) {
  return read_bytes(path, 1 << 20);
}

void put_bytes(const std::string& path, std::span<const std::byte> bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

TEST(Checkpoint, BringsBackWhatWasPutIn) {
  const Folder folder;

  const auto shares = read_all(write_some(folder.path()));

  ASSERT_EQ(shares.size(), 2U);
  CheckpointShare expected = some_share(12, 101);
  const CheckpointShare second = some_share(8, 151);
  for (auto& total : expected.totals) total += 3;
  expected.ids.insert(expected.ids.end(), second.ids.begin(), second.ids.end());
  expected.velocities.insert(expected.velocities.end(), second.velocities.begin(),
                             second.velocities.end());
  EXPECT_EQ(shares[1].ids, expected.ids);
  EXPECT_EQ(shares[1].velocities, expected.velocities);
  EXPECT_EQ(shares[1].totals, expected.totals);
  EXPECT_EQ(shares[1].wall_contact_images, (std::vector<std::int32_t>{-1, 0, 2, -1, 0, 2}));
  EXPECT_TRUE(std::signbit(shares[1].wall_contact_springs[0]))
      << "the sign of a zero is part of the state";
}

TEST(Checkpoint, BringsBackTheState) {
  const CheckpointState expected = some_state();

  const CheckpointState state = decode_state(encode(expected), "file");

  EXPECT_EQ(encode(state), encode(expected));
  EXPECT_EQ(state.look.outside, 7);
  EXPECT_EQ(state.walls[1].point[1], 0.75);
}

TEST(Checkpoint, DetectsEveryFlippedBit) {
  const Folder folder;
  const std::string checkpoint = write_some(folder.path());
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(checkpoint))
    files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  ASSERT_EQ(files.size(), 3U);
  std::mt19937_64 random(1);
  int num_detected = 0;
  for (int flip = 0; flip < 1000; ++flip) {
    const std::string& file = files[static_cast<std::size_t>(flip) % files.size()];
    const auto whole = bytes_of(file);
    auto damaged = whole;
    damaged[random() % damaged.size()] ^= static_cast<std::byte>(1U << random() % 8);
    put_bytes(file, damaged);
    try {
      (void)read_all(checkpoint);
    } catch (const InputError&) {
      ++num_detected;
    }
    put_bytes(file, whole);
  }
  EXPECT_EQ(num_detected, 1000);
  EXPECT_NO_THROW((void)read_all(checkpoint));
}

TEST(Checkpoint, RefusesAnotherVersionByItsNumber) {
  const Folder folder;
  auto bytes = bytes_of(write_some(folder.path()) + "/" + rank_file_name(0));
  std::uint32_t version = 0, num_blocks = 0;
  std::memcpy(&version, &bytes[8], sizeof version);
  std::memcpy(&num_blocks, &bytes[32], sizeof num_blocks);
  ++version;
  std::memcpy(&bytes[8], &version, sizeof version);
  std::fill_n(&bytes[56], 8, std::byte{0});
  const std::uint64_t hash = XXH3_64bits(bytes.data(), 64 + 32 * std::size_t{num_blocks});
  std::memcpy(&bytes[56], &hash, sizeof hash);  // sound, but for the version

  try {
    const RankFileView view(bytes, "rank");
    FAIL() << "is read";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("format version " + std::to_string(version)),
              std::string::npos)
        << error.what();
  }
}

TEST(Checkpoint, DetectsEveryCutAndEveryTail) {
  const Folder folder;
  const std::string checkpoint = write_some(folder.path());
  for (const std::string& name :
       {std::string("manifest.json"), rank_file_name(0), rank_file_name(1)}) {
    const std::string file = checkpoint + "/" + name;
    const auto whole = bytes_of(file);
    for (std::size_t length = 0; length < whole.size(); length += 1 + length / 40) {
      put_bytes(file, std::span(whole).first(length));
      EXPECT_THROW((void)read_all(checkpoint), InputError) << name << " of " << length << " bytes";
    }
    auto longer = whole;
    longer.push_back(std::byte{0});
    put_bytes(file, longer);
    EXPECT_THROW((void)read_all(checkpoint), InputError) << name << " with a tail";
    put_bytes(file, whole);
  }
}

TEST(Checkpoint, SurvivesAnyBytes) {
  std::mt19937_64 random(7);
  for (int round = 0; round < 3000; ++round) {
    std::vector<std::byte> bytes(random() % 600);
    for (std::byte& b : bytes) b = static_cast<std::byte>(random() % (round % 2 == 0 ? 256 : 3));
    if (bytes.size() > 64 && round % 3 == 0)
      std::memcpy(bytes.data(), "barchan\n\1\0\0\0\2\0\0\0", 16);
    EXPECT_THROW((void)RankFileView(bytes, "file"), InputError);
    EXPECT_THROW(
        (void)parse_manifest(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
                             "file"),
        InputError);
    EXPECT_THROW((void)decode_state(bytes, "file"), InputError);
  }
}

TEST(Checkpoint, RefusesAManifestWithNumbersThatAreNoCounts) {
  const Manifest manifest{5, 0.1, 2, "a run", {{{64, 1}, 0, 3, 20, 5, 2, 1}}, {}};
  const std::string text = manifest_text(manifest);
  EXPECT_NO_THROW((void)parse_manifest(text, "file"));
  for (const auto& [from, to] :
       {std::pair("\"particles\": 20,\n   \"contacts\"", "\"particles\": 6e36,\n   \"contacts\""),
        {"\"step\": 5", "\"step\": -5"},
        {"\"step\": 5", "\"step\": 1e300"},
        {"\"step\": 5", "\"step\": 9223372036854775807"},
        {"\"version\":", "\"version\": 1e10, \"was\":"},
        {"\"dimension\": 2", "\"dimension\": 4"}}) {
    std::string body = text.substr(0, text.rfind(",\n\"xxh3\""));
    ASSERT_NE(body.find(from), std::string::npos) << from;
    body.replace(body.find(from), std::string(from).size(), to);
    char hash[17];
    std::snprintf(hash, sizeof hash, "%016llx",
                  static_cast<unsigned long long>(XXH3_64bits(body.data(), body.size())));
    EXPECT_THROW((void)parse_manifest(body + ",\n\"xxh3\": \"" + hash + "\"}\n", "file"),
                 InputError)
        << to;
  }
}

TEST(Checkpoint, RefusesColumnsThatDoNotFitEachOther) {
  const auto refuses = [](auto&& spoil) {
    CheckpointShare share = some_share(6, 1);
    EXPECT_NO_THROW(check_share(share, kLimits, "file"));
    spoil(share);
    EXPECT_THROW(check_share(share, kLimits, "file"), InputError);
  };
  refuses([](CheckpointShare& s) { s.positions.pop_back(); });
  refuses([](CheckpointShare& s) { s.velocities.push_back(0.0); });
  refuses([](CheckpointShare& s) { s.positions[3] = std::nan(""); });
  refuses([](CheckpointShare& s) { s.types[0] = 3; });
  refuses([](CheckpointShare& s) { s.contact_ids.pop_back(); });
  refuses([](CheckpointShare& s) { s.contact_springs.pop_back(); });
  refuses([](CheckpointShare& s) { s.wall_contact_walls[0] = -1; });
  refuses([](CheckpointShare& s) { s.wall_contact_images.pop_back(); });
  refuses([](CheckpointShare& s) { s.wall_contact_images[0] = 1 << 30; });
  refuses([](CheckpointShare& s) { s.bond_laws[0] = 1; });
  refuses([](CheckpointShare& s) { s.bond_states.pop_back(); });
  refuses([](CheckpointShare& s) { s.externals = {1.0}; });
  refuses([](CheckpointShare& s) { s.totals.clear(); });
}

TEST(CheckpointFolder, KeepsTheNewestAndDropsAnAbandonedFuture) {
  const Folder folder;
  for (const std::int64_t step : {100, 200, 300, 1000}) (void)write_some(folder.path(), step);
  const CheckpointFolder checkpoints(folder.path());
  checkpoints.begin(400);
  EXPECT_EQ(checkpoints.steps(), (std::vector<std::int64_t>{1000, 300, 200, 100}));

  checkpoints.prune(300, 2);

  EXPECT_EQ(checkpoints.steps(), (std::vector<std::int64_t>{300, 200}));
  EXPECT_TRUE(fs::exists(checkpoints.unfinished(400)));
  checkpoints.clean();
  EXPECT_FALSE(fs::exists(checkpoints.unfinished(400)));
}

TEST(CheckpointFolder, ReplacesOneOfTheSameStep) {
  const Folder folder;
  const std::string checkpoint = write_some(folder.path());
  put_bytes(checkpoint + "/manifest.json", {});

  (void)write_some(folder.path());

  EXPECT_NO_THROW((void)read_all(checkpoint));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1);
}

TEST(CheckpointFolder, BringsBackOneThatWasAboutToBeReplaced) {
  const Folder folder;
  const std::string checkpoint = write_some(folder.path());
  fs::rename(checkpoint, checkpoint + ".old");

  CheckpointFolder(folder.path()).clean();

  EXPECT_NO_THROW((void)read_all(checkpoint));
}

TEST(Durable, LeavesNothingUnderTheNameWhenTheDiskIsFull) {
  const Folder folder;
  const std::string file = folder.path() + "/file";
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto old = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const std::vector<std::byte> bytes(4096);
  const std::span<const std::byte> part(bytes);
  int code = 0;
  try {
    write_durably(file, std::span(&part, 1));
  } catch (const FileError& e) {
    code = e.code();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old);

  EXPECT_EQ(code, EFBIG);
  EXPECT_FALSE(fs::exists(file));
}

TEST(Durable, NamesFileAndCause) {
  try {
    write_durably("/no/such/folder/file", {});
    FAIL();
  } catch (const FileError& e) {
    EXPECT_EQ(e.code(), ENOENT);
    EXPECT_NE(std::string(e.what()).find("/no/such/folder/file: No such file or directory"),
              std::string::npos)
        << e.what();
  }
}

}  // namespace
}  // namespace barchan
