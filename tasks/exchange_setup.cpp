#include <barchan/tasks/exchange_setup.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <barchan/comm/exchanges/make_exchange.hpp>
#include <barchan/comm/wrappers/recorded_exchange.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/tasks/simulation.hpp>

namespace barchan {
namespace {

constexpr const char* kAuto = "auto";
constexpr const char* kReplay = "replay";
constexpr const char* kReturn = "return";
constexpr const char* kBeforeAuto = "isend";
// Of a fast core: work that is longer than this estimate hides more, not less.
constexpr double kSecondsPerParticle = 5e-9, kSecondsPerPair = 3e-9;
constexpr double kLongestWork = 2e-3;  // [s]; longer work hides nothing more, and takes time

bool is_recording(const RunOptions& options) {
  return options.tape != nullptr && !options.tape->is_playing();
}

ExchangeOptions options_of(const RunOptions& options, int depth) {
  ExchangeOptions exchange;
  exchange.depth = depth;
  exchange.hooks = options.hooks;
  return exchange;
}

std::unique_ptr<Exchange> recorded(std::unique_ptr<Exchange> exchange, int num_links,
                                   const RunOptions& options) {
  if (!is_recording(options)) return exchange;
  return std::make_unique<RecordingExchange>(std::move(exchange), num_links, options.tape);
}

template <int Dim>
WorkPattern work_of(const Strip<Dim>& strip) {
  double seconds = 0.0;
  int chunks = 1;
  for (const Lane<Dim>& lane : strip.lanes()) {
    seconds += kSecondsPerParticle * static_cast<double>(lane.brick.store.num_owned) +
               kSecondsPerPair * static_cast<double>(lane.brick.num_pairs());
    chunks = std::max(chunks, lane.brick.num_chunks());
  }
  return {std::min(seconds / strip.num_lanes(), kLongestWork), chunks};
}

}  // namespace

void check_exchange(const std::string& name, const Communicator& communicator) {
  const auto names = exchange_choices();
  if (name == kReplay || std::ranges::find(names, name) != names.end()) return;
  try {
    check_exchange_name(name);
  } catch (const InputError& e) {
    if (communicator.size() == 1) throw;
    const auto neighbours = strip_neighbours(communicator.rank(), communicator.size(), false);
    throw InputError(std::string(e.what()),
                     "here work: auto, return, " + exchanges_here(communicator, neighbours));
  }
}

CutScheme cut_scheme(const RunOptions& options) {
  return options.exchange == kReturn ? CutScheme::Returned : CutScheme::BothSides;
}

std::unique_ptr<Exchange> first_exchange(const RunOptions& options,
                                         const Communicator& communicator,
                                         const Neighbours& neighbours, int depth) {
  check_exchange(options.exchange, communicator);
  const bool has_played_tape = options.tape != nullptr && options.tape->is_playing();
  if (has_played_tape != (options.exchange == kReplay)) {
    throw InputError("exchange 'replay' needs a recorded run",
                     "record a run with RunOptions::tape, rewind the tape, then run again with "
                     "exchange 'replay'");
  }
  if (communicator.size() == 1) return nullptr;
  if (options.exchange == kReplay) {
    return std::make_unique<ReplayExchange>(options.tape, neighbours);
  }
  std::string name = options.exchange;
  if (name == kReturn) name = "sendrecv";
  if (name == kAuto) name = kBeforeAuto;
  return recorded(make_exchange(name, communicator, neighbours, options_of(options, depth)),
                  neighbours.num_links(), options);
}

template <int Dim>
ExchangeChoice settle_exchange(Strip<Dim>& strip, const RunOptions& options,
                               const Communicator& communicator) {
  ExchangeChoice choice;
  choice.name = options.exchange;
  choice.reason = "chosen by name";
  if (communicator.size() == 1) {
    choice.name = "none";
    choice.reason = "one rank has no neighbours";
  }
  if (communicator.size() == 1 || options.exchange != kAuto) return choice;
  SelectedExchange selected = select_exchange(communicator, strip.neighbours(),
                                              options_of(options, strip.map().shape().depth),
                                              strip.most_halo_bytes(), work_of(strip));
  strip.set_exchange(recorded(std::move(selected.exchange), strip.num_links(), options));
  return selected.choice;
}

template ExchangeChoice settle_exchange<2>(Strip<2>&, const RunOptions&, const Communicator&);
template ExchangeChoice settle_exchange<3>(Strip<3>&, const RunOptions&, const Communicator&);

}  // namespace barchan
