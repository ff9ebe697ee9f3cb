#pragma once

#include <barchan/comm/base/communicator.hpp>

namespace barchan {

/// Whether MPI was started so that several threads may call it, one at a time. Local.
[[nodiscard]] bool allows_threads();

/// Holds the threads that will call MPI against the level at which it was started: several need
/// MPI_THREAD_SERIALIZED; below that the calling thread must be the one that started MPI.
/// Collective. Errors: InputError, the same on every rank.
void check_thread_level(const Communicator& communicator, bool several);

}  // namespace barchan
