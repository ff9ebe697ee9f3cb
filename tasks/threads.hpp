#pragma once

#include <barchan/comm/base/communicator.hpp>

namespace barchan {

inline constexpr int kMostThreads = 1024;  ///< of a rank

/// Threads per rank by default: the node's cores over the ranks on it, but no more than this
/// process may run on; one where MPI's thread level allows no more. The same on every rank.
/// Collective.
[[nodiscard]] int default_threads(const Communicator& communicator);

}  // namespace barchan
