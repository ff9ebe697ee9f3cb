#pragma once

namespace barchan {

/// Process-wide request to end the run; see Simulation::request_stop.
[[nodiscard]] bool stop_is_requested() noexcept;
void forget_stop_request() noexcept;

/// Process-wide request to save the state; see Simulation::request_checkpoint.
[[nodiscard]] bool checkpoint_is_requested() noexcept;
void forget_checkpoint_request() noexcept;

}  // namespace barchan
