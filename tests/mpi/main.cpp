// Runs every test on all ranks at once. Rank 0 prints; the others print only what went wrong with
// them. A test that fails on any rank fails on rank 0 too, and a test that hangs is named before
// all ranks are ended.
#include <gtest/gtest.h>
#include <mpi.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

struct Watch {
  char message[512] = {};
  unsigned seconds = 60;
};
Watch g_watch;

extern "C" void on_alarm(int /*signal*/) {
  [[maybe_unused]] const auto written =
      write(STDERR_FILENO, g_watch.message, std::strlen(g_watch.message));
  _exit(124);
}

class RankListener : public testing::EmptyTestEventListener {
 public:
  RankListener(int rank, int num_ranks) : rank_(rank), num_ranks_(num_ranks) {}

 private:
  void OnTestStart(const testing::TestInfo& test) override {
    std::snprintf(g_watch.message, sizeof g_watch.message,
                  "[rank %d of %d] %s.%s did not end within %u s\n", rank_, num_ranks_,
                  test.test_suite_name(), test.name(), g_watch.seconds);
    alarm(g_watch.seconds);
  }

  void OnTestPartResult(const testing::TestPartResult& result) override {
    if (rank_ == 0 || !result.failed()) return;
    const char* file = result.file_name() == nullptr ? "?" : result.file_name();
    std::fprintf(stderr, "[rank %d of %d] %s:%d: %s\n", rank_, num_ranks_, file,
                 result.line_number(), result.message());
  }

  void OnTestEnd(const testing::TestInfo& test) override {
    const int has_failed = test.result()->Failed() ? 1 : 0;
    int num_failed = 0;
    MPI_Allreduce(&has_failed, &num_failed, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
    alarm(0);
    if (rank_ == 0 && num_failed > 0 && has_failed == 0) {
      ADD_FAILURE() << "failed on " << num_failed << " of " << num_ranks_ << " ranks";
    }
  }

  int rank_;
  int num_ranks_;
};

int run_tests() {
  int rank = 0;
  int num_ranks = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &num_ranks);
  auto& listeners = testing::UnitTest::GetInstance()->listeners();
  if (rank != 0) delete listeners.Release(listeners.default_result_printer());
  listeners.Append(new RankListener(rank, num_ranks));  // its ends come before the printer's

  const int status = RUN_ALL_TESTS();
  int worst = 0;
  MPI_Allreduce(&status, &worst, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  return worst;
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (GTEST_FLAG_GET(list_tests)) return RUN_ALL_TESTS();
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);
  if (provided < MPI_THREAD_SERIALIZED) {
    std::fputs("this MPI library does not give MPI_THREAD_SERIALIZED\n", stderr);
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  if (const char* seconds = std::getenv("BARCHAN_TEST_SECONDS")) {
    g_watch.seconds = static_cast<unsigned>(std::stoul(seconds));
  }
  std::signal(SIGALRM, on_alarm);
  const int status = run_tests();
  MPI_Finalize();
  return status;
}
