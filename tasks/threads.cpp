#include <barchan/tasks/threads.hpp>

#include <sched.h>
#include <unistd.h>

#include <algorithm>

#include <barchan/comm/base/thread_level.hpp>

namespace barchan {

int default_threads(const Communicator& communicator) {
  const long cores = sysconf(_SC_NPROCESSORS_ONLN);
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  const bool knows = sched_getaffinity(0, sizeof allowed, &allowed) == 0;
  int share = static_cast<int>(std::max<long>(1, cores / communicator.node_size()));
  if (!allows_threads()) share = 1;
  double fewest = knows ? std::min(share, std::max(1, CPU_COUNT(&allowed))) : share;
  communicator.allreduce_min(std::span(&fewest, 1));
  return static_cast<int>(fewest);
}

}  // namespace barchan
