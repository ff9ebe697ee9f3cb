#pragma once

#include <exception>
#include <functional>
#include <string>

#include <barchan/comm/base/communicator.hpp>

namespace barchan::app {

/// Does the work of a command and turns what it throws into one message on stderr and an exit
/// status.
///
/// An InputError is the same on every rank: rank 0 prints it, all return 2. A CommonError is the
/// same on every rank, too: rank 0 prints it, and all ranks end with status 1. Of any other error
/// one rank alone may know, while the others wait for it: that rank prints it and ends all ranks
/// with status 1.
/// @param world  null without MPI
int with_verdict(const Communicator* world, const std::function<void()>& work);

/// Ends all ranks with status 1 after one message, before anything unwinds that might wait for the
/// others; alone it throws RunError. For errors inside the time loop.
/// @param error  tells whether every rank knows
/// @param what   the message
[[noreturn]] void end_run(const Communicator& world, const std::exception& error,
                          const std::string& what);

/// The same after a WaitError: every rank that waits says what it waits for, so that the one that
/// hangs can be told from those that wait for it in turn.
[[noreturn]] void end_waiting(const Communicator& world, const std::string& what);

/// Does local work on rank 0 alone; every rank throws what it threw. Collective.
void on_rank_zero(const Communicator& world, const std::function<void()>& work);

}  // namespace barchan::app
