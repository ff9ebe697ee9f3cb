#pragma once

#include <string>

namespace barchan {

/// Removes what Open MPI keeps on this node for runs of this user whose processes are all dead:
/// files in shared memory (`vader_segment.HOST...` in /dev/shm) and session folders
/// (`ompi.HOST.UID/pid.N` in the folder for temporary files). They stay where mpirun itself was
/// killed by SIGKILL.
/// A file that a process maps, that is younger than a second, or whose launcher lives, stays.
/// @return how many files and folders went. Local; one rank a node is enough. Never throws.
int remove_leftovers() noexcept;

}  // namespace barchan
