#pragma once

#include <cstddef>

#include <barchan/comm/base/communicator.hpp>

namespace barchan {

/// Half round trip [s] of a put ping-pong in plain MPI calls, without slots, headers and checks:
/// MPI_Put of the data, MPI_Win_flush, MPI_Put of a word, MPI_Win_flush; the other side watches the
/// word. The reference for what `put-flag` costs. Between ranks 2i and 2i + 1; median, slowest
/// pair. Collective. Errors: InputError where no window can be made.
[[nodiscard]] double plain_put_half_round_trip(const Communicator& communicator, std::size_t bytes,
                                               double budget_seconds);

}  // namespace barchan
