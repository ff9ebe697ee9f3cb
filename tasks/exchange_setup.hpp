#pragma once

#include <memory>
#include <string>
#include <vector>

#include <barchan/comm/probe/auto_exchange.hpp>
#include <barchan/tasks/run_options.hpp>
#include <barchan/tasks/strip.hpp>

namespace barchan {

/// Collective. Errors, the same on every rank: InputError for an unknown exchange, with
/// those that work between these ranks and why the others do not.
void check_exchange(const std::string& name, const Communicator& communicator);

/// Of the exchange that the options name.
[[nodiscard]] CutScheme cut_scheme(const RunOptions& options);

/// The exchange that a run begins with: the one that the options name; for `auto` a two-sided one,
/// which works everywhere, until the sizes of messages are known; for `replay` the tape. Null on
/// one rank. Collective. Errors, the same on every rank: InputError for an unknown name (with the
/// list), one that does not work here (with the remedy), or `replay` without a recorded tape.
[[nodiscard]] std::unique_ptr<Exchange> first_exchange(const RunOptions& options,
                                                       const Communicator& communicator,
                                                       const Neighbours& neighbours, int depth);

/// For `auto`: measures and changes to the best. @return what the run uses and why. Collective.
/// @pre the strip's lists are built, nothing is in flight
template <int Dim>
[[nodiscard]] ExchangeChoice settle_exchange(Strip<Dim>& strip, const RunOptions& options,
                                             const Communicator& communicator);

}  // namespace barchan
