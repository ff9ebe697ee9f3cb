#include <barchan/tasks/results/run_folder.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include <barchan/core/error.hpp>

#include <support/temporary_folder.hpp>

namespace fs = std::filesystem;

namespace barchan {
namespace {

class RunFolderTest : public testing::Test {
 protected:
  void touch(const std::string& name) const {
    fs::create_directories(fs::path(root_ + "/" + name).parent_path());
    std::ofstream(root_ + "/" + name) << "x\n";
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
  touch("old.out/run.json");

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
  touch("old.out/run.json");
  touch("old.out/snapshots/step_000000000_rank_7.vtp");
  touch("old.out/notes.txt");

  RunFolder(root_ + "/old.out").begin();

  EXPECT_FALSE(exists("old.out/run.json"));
  EXPECT_FALSE(exists("old.out/snapshots/step_000000000_rank_7.vtp"));
  EXPECT_TRUE(exists("old.out/snapshots"));
  EXPECT_TRUE(exists("old.out/notes.txt"));
}

}  // namespace
}  // namespace barchan
