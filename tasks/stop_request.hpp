#pragma once

namespace barchan {

/// Process-wide request to end the run; see Simulation::request_stop.
[[nodiscard]] bool stop_is_requested() noexcept;

}  // namespace barchan
