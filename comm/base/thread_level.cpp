#include <barchan/comm/base/thread_level.hpp>

#include <string>

#include <barchan/comm/base/mpi_error.hpp>
#include <barchan/comm/base/mpi_session.hpp>

namespace barchan {
namespace {

std::string obstacle(bool several) {
  if (allows_threads()) return {};
  if (several)
    return "several threads need MPI_THREAD_SERIALIZED, and MPI was started at thread level '" +
           mpi_thread_level() + "'";
  int is_main = 0;
  check(MPI_Is_thread_main(&is_main), "MPI_Is_thread_main");
  if (is_main != 0) return {};
  return "at MPI's thread level '" + mpi_thread_level() +
         "' only the thread that started MPI may use it";
}

}  // namespace

bool allows_threads() {
  int level = MPI_THREAD_SINGLE;
  check(MPI_Query_thread(&level), "MPI_Query_thread");
  return level >= MPI_THREAD_SERIALIZED;
}

void check_thread_level(const Communicator& communicator, bool several) {
  const std::string error = communicator.first_error(obstacle(several));
  if (error.empty()) return;
  throw InputError(error,
                   "start MPI by MPI_Init_thread with MPI_THREAD_SERIALIZED or more, or use one "
                   "thread, the one that started MPI");
}

}  // namespace barchan
