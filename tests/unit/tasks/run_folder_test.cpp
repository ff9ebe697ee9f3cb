#include <barchan/tasks/results/folder_claim.hpp>
#include <barchan/tasks/results/run_folder.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include <barchan/core/base/error.hpp>

#include <support/temporary_folder.hpp>

namespace fs = std::filesystem;

namespace barchan {
namespace {

constexpr const char* kRunJson = "{\n  \"state_digest\": \"0\"\n}\n";
constexpr const char* kVtp = "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\"";

class RunFolderTest : public testing::Test {
 protected:
  void touch(const std::string& name, const std::string& text = "x\n") const {
    fs::create_directories(fs::path(root_ + "/" + name).parent_path());
    std::ofstream(root_ + "/" + name) << text;
  }
  [[nodiscard]] bool exists(const std::string& name) const {
    return fs::exists(root_ + "/" + name);
  }

  test::TemporaryFolder folder_;
  const std::string& root_ = folder_.path();
};

TEST_F(RunFolderTest, IsNamedAfterTheDeck) {
  EXPECT_EQ(RunFolder::of_deck("some/where/soil.toml").path(), "soil.out");
}

TEST_F(RunFolderTest, CheckChangesNothing) {
  RunFolder(root_ + "/new/run.out").check(false);

  EXPECT_FALSE(exists("new"));
}

TEST_F(RunFolderTest, RefusesAnExistingFolderUnlessItMayBeReplaced) {
  touch("old.out/run.json", kRunJson);

  EXPECT_THROW(RunFolder(root_ + "/old.out").check(false), InputError);
  EXPECT_NO_THROW(RunFolder(root_ + "/old.out").check(true));
}

TEST_F(RunFolderTest, RefusesAFileInTheWay) {
  touch("file");

  EXPECT_THROW(RunFolder(root_ + "/file").check(true), InputError);
  EXPECT_THROW(RunFolder(root_ + "/file/run.out").check(true), InputError);
  EXPECT_THROW(RunFolder(root_ + "/file/deeper/run.out").check(true), InputError);
}

TEST_F(RunFolderTest, BeginRemovesResultsAndNothingElse) {
  touch("old.out/run.json", kRunJson);
  touch("old.out/series_12.csv", "step,time,kine");  // a full disk cut it
  touch("old.out/snapshots/step_000000000_rank_7.vtp", kVtp);
  touch("old.out/checkpoints/step_000000100/rank_00000.bin");
  touch("old.out/checkpoints/mine");
  touch("old.out/snapshots/step_0_rank_7.vtp");
  touch("old.out/notes.txt");

  RunFolder(root_ + "/old.out").begin();

  EXPECT_FALSE(exists("old.out/run.json"));
  EXPECT_FALSE(exists("old.out/series_12.csv"));
  EXPECT_FALSE(exists("old.out/snapshots/step_000000000_rank_7.vtp"));
  EXPECT_FALSE(exists("old.out/checkpoints/step_000000100"));
  EXPECT_TRUE(exists("old.out/checkpoints/mine"));
  EXPECT_TRUE(exists("old.out/snapshots/step_0_rank_7.vtp"));
  EXPECT_TRUE(exists("old.out/notes.txt"));
}

TEST_F(RunFolderTest, RemovesNothingWhereAnotherFileIsInTheWay) {
  for (const char* name : {"log.txt", "picture.png", "checkpoints/step_000000200/notes.txt",
                           "checkpoints/step_000000100.part", "snapshots/step_000000100.pvtp"}) {
    fs::remove_all(root_ + "/old.out");
    touch("old.out/run.json", kRunJson);
    touch(std::string("old.out/") + name);

    EXPECT_THROW(RunFolder(root_ + "/old.out").check(true), InputError) << name;
    EXPECT_THROW(RunFolder(root_ + "/old.out").begin(), InputError) << name;
    EXPECT_THROW(RunFolder(root_ + "/old.out").resume(), InputError) << name;
    EXPECT_TRUE(exists("old.out/run.json")) << name;
    EXPECT_TRUE(exists(std::string("old.out/") + name));
  }
}

TEST_F(RunFolderTest, IsClaimedByOneAtATime) {
  const RunFolder folder(root_ + "/deep/er/run.out");
  {
    const FolderClaim claim(folder, false);
    EXPECT_TRUE(exists("deep/er/run.out/run.lock"));
    EXPECT_THROW(FolderClaim(folder, true), InputError);
    EXPECT_TRUE(exists("deep/er/run.out/run.lock"));
  }
  EXPECT_FALSE(exists("deep"));
}

TEST_F(RunFolderTest, ARefusedClaimChangesNothing) {
  touch("old.out/run.json", kRunJson);

  EXPECT_THROW(FolderClaim(RunFolder(root_ + "/old.out"), false), InputError);

  EXPECT_TRUE(exists("old.out/run.json"));
  EXPECT_FALSE(exists("old.out/run.lock"));
}

TEST_F(RunFolderTest, TakesOverWhatTheDeadHold) {
  touch("new.out/run.lock", "host lab1\npid 4242\nstarted 5\nsince long ago\n");

  const FolderClaim claim(RunFolder(root_ + "/new.out"), false);

  EXPECT_EQ(claim.former(), "process 4242 on lab1 since long ago");
}

TEST(SnapshotStep, KnowsTheNamesOfARunAlone) {
  EXPECT_EQ(snapshot_step("step_000000500.pvtp"), 500);
  EXPECT_EQ(snapshot_step("step_12345678901_rank_12.vtp"), 12345678901);
  for (const char* name :
       {"step_500.pvtp", "step_000000500.vtp", "step_000000500_rank_.vtp", "step_",
        "step_000000500_rank_01.vtp", "step_000000500_mine.vtp", "run.pvd"})
    EXPECT_FALSE(snapshot_step(name)) << name;
}

}  // namespace
}  // namespace barchan
