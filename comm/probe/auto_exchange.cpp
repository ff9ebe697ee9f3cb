#include <barchan/comm/probe/auto_exchange.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

#include <barchan/comm/exchanges/make_exchange.hpp>
#include <barchan/core/base/clock.hpp>
#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

constexpr double kBudgetSeconds = 0.02;  // for each measurement of a candidate
constexpr double kEqualShare = 1.1;
constexpr double kEqualSeconds = 0.5e-6;

/// The largest message and the least work of all ranks.
void agree_pattern(const Communicator& communicator, std::size_t& bytes, WorkPattern& work) {
  double maxima[2] = {static_cast<double>(bytes), -work.seconds};
  communicator.allreduce_max(std::span<double>(maxima));
  std::int64_t chunks = -work.num_chunks;
  communicator.allreduce_max(std::span(&chunks, 1));
  bytes = static_cast<std::size_t>(maxima[0]);
  work = {-maxima[1], static_cast<int>(-chunks)};
}

ExchangeCandidate measure(const std::string& name, const Communicator& communicator,
                          const Neighbours& neighbours, const ExchangeOptions& options,
                          const ExchangeChoice& choice) {
  ExchangeCandidate candidate;
  candidate.name = name;
  try {
    const auto exchange = make_exchange(name, communicator, neighbours, options);
    ExchangeProbe probe(communicator, neighbours, *exchange, choice.bytes, kBudgetSeconds);
    candidate.exposed = probe.exposed(choice.work);
    candidate.half_round_trip = probe.half_round_trip();
  } catch (const InputError& e) {
    candidate.obstacle = e.what();
  }
  return candidate;
}

bool is_mix(const std::string& name) {
  return name.find('+') != std::string::npos;
}

/// Between all ranks; a mix needs what its far part needs.
bool needs_window(const std::string& name) {
  const std::string far = name.substr(name.find('+') + 1);
  return far == "put-flag" || far == "put-inband" || far == "get" || far == "pscw";
}

/// The preferred among those that are as good as the best.
std::size_t best_of(const std::vector<ExchangeCandidate>& candidates) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& c : candidates) {
    if (c.obstacle.empty()) least = std::min(least, c.exposed);
  }
  const double good = std::max(least * kEqualShare, least + kEqualSeconds);
  const auto found = std::ranges::find_if(candidates, [good](const ExchangeCandidate& c) {
    return c.obstacle.empty() && c.exposed <= good;
  });
  return static_cast<std::size_t>(found - candidates.begin());
}

std::string in_microseconds(double seconds) {
  return fmt::format("{:.3g} µs", 1e6 * seconds);
}

std::string reason_for(const ExchangeChoice& choice, const ExchangeCandidate& best) {
  std::string others;
  for (const auto& c : choice.candidates) {
    if (c.name == best.name || !c.obstacle.empty()) continue;
    others +=
        fmt::format("{}{} {}", others.empty() ? "" : ", ", c.name, in_microseconds(c.exposed));
  }
  return fmt::format("{} adds {} to a step of {} with messages of {} bytes{}{}", best.name,
                     in_microseconds(best.exposed), in_microseconds(choice.work.seconds),
                     choice.bytes, others.empty() ? "" : "; the others: ", others);
}

}  // namespace

std::vector<std::string> auto_candidates(const Links& links) {
  std::vector<std::string> names{"put-inband", "put-flag", "get", "pscw", "isend"};
  if (!links.are_of_both_kinds()) {
    names.insert(names.begin(), "shared");
    return names;
  }
  // Within a node shared memory has always been cheapest.
  std::vector<std::string> mixes{"shared+put-inband", "shared+put-flag", "shared+get",
                                 "shared+isend"};
  names.insert(names.begin(), mixes.begin(), mixes.end());
  return names;
}

SelectedExchange select_exchange(const Communicator& communicator, const Neighbours& neighbours,
                                 const ExchangeOptions& options, std::size_t bytes,
                                 WorkPattern work) {
  const std::int64_t begin = now_ns();
  agree_pattern(communicator, bytes, work);
  ExchangeOptions sized = options;
  sized.halo_bytes = std::max(options.halo_bytes, bytes);
  ExchangeChoice choice;
  choice.is_measured = true;
  choice.bytes = bytes;
  choice.work = work;
  const Links links = count_links(communicator, neighbours, options.hooks.ranks_per_node);
  for (const std::string& name : auto_candidates(links)) {
    // With a depth it has a window for each message that may be under way, which take long to make.
    if (options.depth > 0 && name.find("pscw") != std::string::npos) continue;
    if (needs_window(name) && !choice.hint.empty()) {  // what one lacks, all lack
      choice.candidates.push_back({name, choice.hint});
      continue;
    }
    choice.candidates.push_back(measure(name, communicator, neighbours, sized, choice));
    // A mix may lack no more than the memory shared within a node.
    if (needs_window(name) && !is_mix(name)) choice.hint = choice.candidates.back().obstacle;
  }
  const std::size_t best = best_of(choice.candidates);
  choice.name = choice.candidates[best].name;
  choice.reason = reason_for(choice, choice.candidates[best]);
  auto chosen = make_exchange(choice.name, communicator, neighbours, sized);  // anew: its figures
  choice.seconds = seconds_since(begin);
  communicator.allreduce_max(std::span(&choice.seconds, 1));
  return {std::move(chosen), choice};
}

}  // namespace barchan
