#pragma once

#include <mpi.h>

#include <cstdlib>

namespace barchan::test {

/// Starts MPI on the first call and ends it with the process: for the few unit tests that need a
/// communicator.
inline MPI_Comm world() {
  int is_initialized = 0;
  MPI_Initialized(&is_initialized);
  if (is_initialized == 0) {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
    std::atexit([] { MPI_Finalize(); });
  }
  return MPI_COMM_WORLD;
}

}  // namespace barchan::test
