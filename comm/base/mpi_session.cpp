#include <barchan/comm/base/mpi_session.hpp>

#include <chrono>
#include <cstdlib>
#include <exception>
#include <thread>

#include <barchan/comm/base/call_watch.hpp>
#include <barchan/comm/base/mpi_error.hpp>

namespace barchan {
namespace {

constexpr double kPatience = 10.0;  // wait limits: others may still be started, or write files

/// MPICH before 4.2 over UCX: a rank that has taken its leave waits in MPI_Finalize without moving
/// messages, so one that is slower by then waits for ever (pmodels/mpich #6596). Seldom where all
/// begin at once after a pause in which nobody is in MPI.
/// @return how long MPI_Finalize may take then [wait limits]
double leave_together() {
#if defined(MPICH_NUMVERSION) && MPICH_NUMVERSION < 40200000
  constexpr std::chrono::milliseconds pause{20};
  const CallWatch watch("MPI_Barrier", kPatience);
  MPI_Barrier(MPI_COMM_WORLD);
  std::this_thread::sleep_for(pause);
  return 0.5;  // nothing is left to be done
#else
  return kPatience;
#endif
}

}  // namespace

MpiSession::MpiSession() {
  start(nullptr, nullptr);
}
MpiSession::MpiSession(int& argc, char**& argv) {
  start(&argc, &argv);
}

void MpiSession::start(int* argc, char*** argv) {
  if (is_mpi_initialized()) return;
  int provided = MPI_THREAD_SINGLE;
  {
    const CallWatch watch("MPI_Init_thread", kPatience);
    check(MPI_Init_thread(argc, argv, MPI_THREAD_SERIALIZED, &provided), "MPI_Init_thread");
  }
  is_owner_ = true;
  if (provided < MPI_THREAD_SERIALIZED) {
    MPI_Finalize();
    is_owner_ = false;
    throw RunError(
        "this MPI library gives less than MPI_THREAD_SERIALIZED, which barchan needs: "
        "use one that was built with thread support");
  }
}

MpiSession::~MpiSession() {
  if (!is_owner_ || !is_mpi_initialized()) return;
  const CallWatch watch("MPI_Finalize", leave_together());
  MPI_Finalize();
}

std::string mpi_library_version() {
  char text[MPI_MAX_LIBRARY_VERSION_STRING] = {};
  int length = 0;
  check(MPI_Get_library_version(text, &length), "MPI_Get_library_version");
  const std::string whole(text, static_cast<std::size_t>(length));
  return whole.substr(0, whole.find_first_of("\n,"));
}

std::string mpi_thread_level() {
  int level = MPI_THREAD_SINGLE;
  check(MPI_Query_thread(&level), "MPI_Query_thread");
  if (level == MPI_THREAD_MULTIPLE) return "multiple";
  if (level == MPI_THREAD_SERIALIZED) return "serialized";
  return level == MPI_THREAD_FUNNELED ? "funneled" : "single";
}

int rank_by_launcher() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"}) {
    if (const char* rank = std::getenv(name)) return std::atoi(rank);
  }
  return 0;
}

bool is_mpi_initialized() {
  int is_initialized = 0;
  int is_finalized = 0;
  MPI_Initialized(&is_initialized);
  MPI_Finalized(&is_finalized);
  return is_initialized != 0 && is_finalized == 0;
}

}  // namespace barchan
