#pragma once

#include <barchan/comm/base/communicator.hpp>

// Communicators as integers, for bindings: MPI_Comm_c2f gives one whatever the MPI library.

namespace barchan {

/// A duplicate of the communicator that this integer stands for. Collective over its ranks.
/// Errors: InputError: it stands for none; as Communicator's
[[nodiscard]] Communicator communicator_of(int fortran_handle);
/// The integer of MPI_COMM_WORLD.
[[nodiscard]] int world_handle();

}  // namespace barchan
