#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <barchan/comm/slots/exchange.hpp>

namespace barchan {

/// Builds the exchange called `name` on a duplicate of `communicator`. Collective. "a+b" is a
/// between ranks of a node and b between nodes.
/// Errors, the same on every rank: InputError for an unknown name (with the list), and, with the
/// remedy, where this MPI or network cannot carry it.
[[nodiscard]] std::unique_ptr<Exchange> make_exchange(std::string_view name,
                                                      const Communicator& communicator,
                                                      const Neighbours& neighbours,
                                                      const ExchangeOptions& options = {});

/// Names that make_exchange takes, alone or as "a+b"; the default first.
[[nodiscard]] std::vector<std::string> exchange_names();

/// Errors: InputError for a name, or one in "a+b", that make_exchange does not know.
void check_exchange_name(std::string_view name);

/// Which exchanges work between these ranks, and why the others do not; for people. Makes each of
/// them. Collective; the same on every rank.
[[nodiscard]] std::string exchanges_here(const Communicator& communicator,
                                         const Neighbours& neighbours);

}  // namespace barchan
