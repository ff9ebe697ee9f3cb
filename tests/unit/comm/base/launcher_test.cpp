#include <barchan/comm/base/launcher.hpp>

#include <gtest/gtest.h>

#include <cstdlib>
#include <initializer_list>
#include <string>
#include <utility>

namespace barchan {
namespace {

class Environment {
 public:
  Environment(std::initializer_list<std::pair<const char*, const char*>> variables) {
    clear();
    for (const auto& [name, value] : variables) ::setenv(name, value, 1);
  }
  ~Environment() { clear(); }

 private:
  static void clear() {
    for (const char* name :
         {"OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK", "PMI_SIZE", "PMI_RANK", "SLURM_NTASKS",
          "SLURM_STEP_NUM_TASKS", "SLURM_STEP_ID", "SLURM_PROCID"})
      ::unsetenv(name);
  }
};

LauncherMismatch in(std::initializer_list<std::pair<const char*, const char*>> variables,
                    int world_size = 1) {
  const Environment environment(variables);
  return launcher_mismatch(world_size);
}

TEST(Launcher, IsWrongWhereSeveralProcessesTakeThemselvesForTheOnlyOne) {
  for (const auto& variables : {std::pair{"PMI_SIZE", "PMI_RANK"},
                                {"OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"},
                                {"SLURM_STEP_NUM_TASKS", "SLURM_PROCID"}}) {
    const auto first = in({{variables.first, "3"}, {variables.second, "0"}});
    const auto last = in({{variables.first, "3"}, {variables.second, "2"}});
    EXPECT_NE(first.what.find(std::string("3 processes (") + variables.first), std::string::npos);
    EXPECT_TRUE(first.is_first);
    EXPECT_TRUE(last && !last.is_first);
  }
  EXPECT_TRUE(in({{"SLURM_NTASKS", "4"}, {"SLURM_PROCID", "1"}}));
}

TEST(Launcher, IsRightWhereItStartedOneOrMpiFoundAll) {
  EXPECT_FALSE(in({}));
  EXPECT_FALSE(in({{"PMI_SIZE", "1"}}));
  EXPECT_FALSE(in({{"PMI_SIZE", "4"}}, 4));
  EXPECT_FALSE(in({{"OMPI_COMM_WORLD_SIZE", "1"}, {"SLURM_STEP_NUM_TASKS", "4"}}));  // one in srun
  EXPECT_FALSE(in({{"SLURM_NTASKS", "4"}, {"SLURM_PROCID", "0"}}));  // a batch script's process
}

}  // namespace
}  // namespace barchan
