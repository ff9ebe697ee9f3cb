#include <barchan/comm/exchanges/make_exchange.hpp>

#include <array>
#include <vector>

#include <barchan/comm/exchanges/all.hpp>
#include <barchan/comm/slots/obstacles.hpp>
#include <barchan/comm/wrappers/delayed_exchange.hpp>
#include <barchan/comm/wrappers/mixed_exchange.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/core/base/nearest.hpp>

namespace barchan {
namespace {

struct Entry {
  std::string_view name;
  std::string_view summary;
  std::unique_ptr<SlotExchange> (*make)(const Communicator&, const Neighbours&);
};

constexpr std::array kEntries{
    Entry{"put-flag", "one-sided: put, flush, flag word, flush", make_put_flag},
    Entry{"put-inband", "one-sided: one put; its number and checksum show that it is complete",
          make_put_inband},
    Entry{"get", "one-sided: a flag word, then the reader pulls by MPI_Rget", make_get},
    Entry{"shared", "memory shared on one node: stores and an atomic word, no MPI in a step",
          make_shared_memory},
    Entry{"pscw", "one-sided: post, start, put, complete, test", make_pscw},
    Entry{"fence", "one-sided: put between fences of all ranks (blocking)", make_fence},
    Entry{"isend", "two-sided, non-blocking: MPI_Isend and persistent receives", make_isend},
    Entry{"sendrecv", "two-sided, blocking, as in the published code", make_sendrecv},
};

const Entry& entry_of(std::string_view name) {
  for (const Entry& entry : kEntries) {
    if (entry.name == name) return entry;
  }
  std::vector<std::string_view> known;
  std::string all;
  for (const Entry& entry : kEntries) {
    known.push_back(entry.name);
    all += (all.empty() ? "" : ", ") + std::string(entry.name);
  }
  const std::string_view near = deck::nearest(name, known);
  throw InputError(
      "unknown exchange '" + std::string(name) + "'",
      (near.empty() ? "" : "did you mean '" + std::string(near) + "'? ") + "there are: " + all);
}

std::unique_ptr<Exchange> make_plain(std::string_view name, const Communicator& communicator,
                                     const Neighbours& neighbours, const ExchangeOptions& options) {
  std::unique_ptr<SlotExchange> exchange = entry_of(name).make(communicator, neighbours);
  exchange->start({options.halo_bytes, options.bulk_bytes, options.depth});
  return exchange;
}

}  // namespace

std::unique_ptr<Exchange> make_exchange(std::string_view name, const Communicator& communicator,
                                        const Neighbours& neighbours,
                                        const ExchangeOptions& options) {
  check_exchange_name(name);
  const auto parts = ExchangeMix::parse(name);
  std::unique_ptr<Exchange> exchange =
      parts ? std::make_unique<MixedExchange>(*parts, communicator, neighbours, options, make_plain)
            : make_plain(name, communicator, neighbours, options);
  if (!(options.hooks.max_delay_seconds > 0.0)) return exchange;
  const std::uint64_t seed =
      options.hooks.delay_seed * 1000003U + static_cast<std::uint64_t>(communicator.rank());
  return std::make_unique<DelayedExchange>(std::move(exchange), neighbours.num_links(),
                                           options.hooks.max_delay_seconds, seed);
}

void check_exchange_name(std::string_view name) {
  const auto parts = ExchangeMix::parse(name);
  if (!parts) return static_cast<void>(entry_of(name));
  for (const std::string& part : {parts->near, parts->far}) {
    if (entry_of(part).name != "fence") continue;
    throw InputError("exchange 'fence' cannot be mixed with another",
                     "a fence involves all ranks; mix two other exchanges, as in "
                     "'shared+put-inband'");
  }
}

std::string exchanges_here(const Communicator& communicator, const Neighbours& neighbours) {
  std::string working;
  std::vector<ExchangeObstacle> others;
  for (const Entry& entry : kEntries) {
    try {
      (void)make_plain(entry.name, communicator, neighbours, {});
      working += (working.empty() ? "" : ", ") + std::string(entry.name);
    } catch (const InputError& e) {
      others.push_back({std::string(entry.name), e.what()});
    }
  }
  std::string text = working + "; or two of them as A+B, A within a node and B between nodes";
  for (const std::string& line : lines_of(others)) text += "\n  not here: " + line;
  return text;
}

std::vector<std::string> exchange_names() {
  std::vector<std::string> names;
  names.reserve(kEntries.size());
  for (const Entry& entry : kEntries) names.emplace_back(entry.name);
  return names;
}

}  // namespace barchan
