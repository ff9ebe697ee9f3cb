#pragma once

#include <string>

namespace barchan {

/// MPI for a program's whole life: MPI_Init_thread(SERIALIZED) and MPI_Finalize, each only where no
/// other code has done it. Only a program's main makes one; the library never starts MPI unasked. A
/// singleton (no mpirun) is a run of one rank. Errors: MpiError; RunError when the library gives
/// less than MPI_THREAD_SERIALIZED.
class MpiSession {
 public:
  MpiSession();
  MpiSession(int& argc, char**& argv);
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

 private:
  void start(int* argc, char*** argv);
  bool is_owner_ = false;
};

std::string mpi_library_version();  ///< first line of the library's own version text
std::string mpi_thread_level();     ///< "single", "funneled", "serialized" or "multiple"
int rank_by_launcher();     ///< as mpirun or srun told this process without MPI; 0: nothing said
bool is_mpi_initialized();  ///< between MPI_Init and MPI_Finalize

}  // namespace barchan
