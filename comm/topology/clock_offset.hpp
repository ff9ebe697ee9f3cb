#pragma once

#include <cstdint>

#include <barchan/comm/base/communicator.hpp>

namespace barchan {

/// What to add to this rank's now_ns() to read rank 0's clock [ns]. Zero on rank 0's node, whose
/// processes share one clock; elsewhere from the fastest of 50 round trips, good to half of what
/// that trip's two ways differ by. Collective. Errors: MpiError.
[[nodiscard]] std::int64_t clock_offset_ns(const Communicator& communicator);

}  // namespace barchan
