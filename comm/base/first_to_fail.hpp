#pragma once

#include <chrono>

#include <barchan/comm/base/communicator.hpp>
#include <barchan/core/base/error.hpp>

namespace barchan {

/// Ranks that found, each alone, that a run goes wrong tell all others, and hear for some time what
/// others say. A rank may come into its next step with what a neighbour sent before it failed, and
/// fail over that as well.
/// @param order  of what this rank found
/// @return whether nothing is known that comes before it; of equal ones the lowest rank's is first
/// Local: no rank needs to answer; all of them are about to be ended (Communicator::abort). Errors:
/// MpiError.
[[nodiscard]] bool is_first_to_fail(const Communicator& communicator, const StepError::Order& order,
                                    std::chrono::milliseconds time);

}  // namespace barchan
