#include <barchan/comm/base/fortran_handle.hpp>

#include <string>

#include <barchan/comm/base/mpi_session.hpp>
#include <barchan/core/base/error.hpp>

namespace barchan {

Communicator communicator_of(int fortran_handle) {
  if (!is_mpi_initialized())
    throw InputError("MPI does not run", "start it with MPI_Init_thread before");
  const MPI_Comm comm = MPI_Comm_f2c(static_cast<MPI_Fint>(fortran_handle));
  if (comm == MPI_Comm{} || comm == MPI_COMM_NULL)
    throw InputError("the handle " + std::to_string(fortran_handle) + " is of no communicator",
                     "give MPI_Comm_c2f(communicator) of one with this rank");
  return {comm};
}

int world_handle() {
  return static_cast<int>(MPI_Comm_c2f(MPI_COMM_WORLD));
}

}  // namespace barchan
