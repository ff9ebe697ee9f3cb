#pragma once

#include <chrono>
#include <cstdint>

#include <barchan/comm/communicator.hpp>

namespace barchan {

/// Ranks that found, each alone, that a run goes wrong tell all others, and hear for some time what
/// others say. A rank may come into its next step with what a neighbour sent before it failed, and
/// fail over that as well.
/// @param step  in which this rank failed
/// @return whether none is known that failed in a step before, or in this one with a lower rank
/// Local: no rank needs to answer; all of them are about to be ended (Communicator::abort). Errors:
/// MpiError.
[[nodiscard]] bool is_first_to_fail(const Communicator& communicator, std::int64_t step,
                                    std::chrono::milliseconds time);

}  // namespace barchan
