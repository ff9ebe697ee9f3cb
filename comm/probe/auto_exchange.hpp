#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <barchan/comm/probe/probe.hpp>
#include <barchan/comm/slots/exchange.hpp>
#include <barchan/comm/topology/links.hpp>

namespace barchan {

/// One exchange that might have been taken.
struct ExchangeCandidate {
  std::string name;
  std::string obstacle;          ///< why it does not work here; empty: it does
  double exposed = 0.0;          ///< added to a step with the work of this run [s], slowest rank
  double half_round_trip = 0.0;  ///< [s]
};

/// Which exchange a run uses and why; the same on every rank.
struct ExchangeChoice {
  std::string name;
  std::string reason;  ///< one line for people
  std::string hint;    ///< how one-sided communication would work here; empty where it does
  bool is_measured = false;
  std::size_t bytes = 0;                      ///< of the messages measured with
  WorkPattern work;                           ///< in each step, of the rank with the least
  double seconds = 0.0;                       ///< that the choice took
  std::vector<ExchangeCandidate> candidates;  ///< measured, in order of preference
};

struct SelectedExchange {
  std::unique_ptr<Exchange> exchange;
  ExchangeChoice choice;
};

/// Names that select_exchange measures, in order of preference among equals: where some neighbours
/// share a node and others do not, mixes too. The blocking ones hide nothing and are left out.
[[nodiscard]] std::vector<std::string> auto_candidates(const Links& links);

/// Measures the exchanges that do not block, on the real neighbours, for under a second in all, and
/// makes the one that adds least to a step with this work. Within 10 % or half a microsecond of the
/// best the preferred one is taken. When no window can be made the two-sided one remains.
/// Only the time that a run takes depends on the outcome. Collective; the verdict is common.
/// @param bytes  of a halo message; the largest of all ranks counts
/// @param work   of a step; the least of all ranks counts
/// Errors: MpiError, RunError.
[[nodiscard]] SelectedExchange select_exchange(const Communicator& communicator,
                                               const Neighbours& neighbours,
                                               const ExchangeOptions& options, std::size_t bytes,
                                               WorkPattern work);

}  // namespace barchan
