#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include <barchan/comm/base/spin_work.hpp>
#include <barchan/comm/base/watchdog.hpp>
#include <barchan/comm/probe/probe.hpp>
#include <barchan/core/base/clock.hpp>

namespace barchan {
namespace {

constexpr int kNumPieces = 8;
// Ranks that have been apart meet in the first steps, which do not count.
constexpr int kNumFirst = 2, kLeastRepetitions = 3, kMostRepetitions = 1000;

/// The value that this share of all is at most.
double percentile(std::vector<double>& values, double share) {
  const auto rank = static_cast<std::size_t>(share * static_cast<double>(values.size()));
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(std::min(rank, values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

double median(std::vector<double>& values) {
  return percentile(values, 0.5);
}

SpinWork& work_of_this_thread() {
  thread_local SpinWork work;
  return work;
}

}  // namespace

ExchangeProbe::ExchangeProbe(const Communicator& communicator, const Neighbours& neighbours,
                             Exchange& exchange, std::size_t bytes, double budget_seconds)
    : communicator_(communicator),
      neighbours_(neighbours),
      exchange_(exchange),
      bytes_(bytes),
      budget_(budget_seconds) {
  exchange_.reserve(bytes);
  communicator_.barrier();
  for (int warm_up = 0; warm_up < 3; ++warm_up) (void)step({}, true);
}

double ExchangeProbe::slowest(double mine) const {
  communicator_.allreduce_max(std::span(&mine, 1));
  return mine;
}

double ExchangeProbe::both_ways() {
  if (both_ways_ == 0.0) both_ways_ = slowest(median_step({}, true).whole);
  return both_ways_;
}

ExchangeProbe::Spread ExchangeProbe::spread_of(std::vector<double>& times) {
  return {median(times), percentile(times, 0.99), percentile(times, 1.0)};
}

// All ranks repeat equally often: blocks that grow, and after each a look whether the slowest has
// time left. A machine that is busy with other work so takes longer for fewer repetitions, not for
// all of them.
template <class Once>
void ExchangeProbe::repeat(Once&& once) {
  const std::int64_t begin = now_ns();
  int num_done = 0;
  for (; repetitions_ > 0 && num_done < kNumFirst + repetitions_; ++num_done)
    once(num_done >= kNumFirst);
  if (repetitions_ > 0) return;
  for (int block = kNumFirst + kLeastRepetitions; num_done < kMostRepetitions; block *= 2) {
    for (int n = 0; n < block; ++n) once(num_done + n >= kNumFirst);
    num_done += block;
    // Twice as many take twice as long.
    if (slowest(seconds_since(begin)) * 2.0 > budget_) return;
  }
}

void ExchangeProbe::send(int link) {
  if (!neighbours_.has(link)) return;
  const auto message = exchange_.outgoing(link, bytes_);
  if (!message.empty()) message.front() = message.back() = std::byte{1};
  exchange_.send(link);
}

bool ExchangeProbe::poll_all() {
  bool all = true;
  for (int link = 0; link < neighbours_.num_links(); ++link) {
    if (neighbours_.has(link) && !exchange_.poll(link)) all = false;
  }
  return all;
}

ExchangeProbe::Step ExchangeProbe::step(const WorkPattern& work, bool polls) {
  Step times;
  const std::int64_t begin = now_ns();
  const auto timed = [&times](auto&& call) {
    const std::int64_t from = now_ns();
    const bool result = call();
    times.in_calls += seconds_since(from);
    return result;
  };
  timed([&] {
    for (int link = 0; link < neighbours_.num_links(); ++link) send(link);
    return true;
  });
  bool is_in = false;
  for (int piece = 0; piece < work.num_chunks && work.seconds > 0.0; ++piece) {
    work_of_this_thread().run(work.seconds / work.num_chunks);
    if (polls && !is_in) is_in = timed([&] { return poll_all(); });
  }
  if (!is_in) {
    wait_until([&] { return poll_all(); },
               [&] {
                 return "rank " + std::to_string(communicator_.rank()) + ": probe of exchange '" +
                        std::string(exchange_.name()) + "', a message of " +
                        std::to_string(bytes_) + " bytes";
               });
  }
  timed([&] {
    for (int link = 0; link < neighbours_.num_links(); ++link) {
      if (neighbours_.has(link)) exchange_.release(link);
    }
    return true;
  });
  times.whole = seconds_since(begin);
  return times;
}

ExchangeProbe::Step ExchangeProbe::median_step(const WorkPattern& work, bool polls) {
  std::vector<double> wholes, calls;
  communicator_.barrier();
  repeat([&](bool counts) {
    const Step one = step(work, polls);
    if (!counts) return;
    wholes.push_back(one.whole);
    calls.push_back(one.in_calls);
  });
  wholes_ = spread_of(wholes);
  return {wholes_.median, median(calls)};
}

double ExchangeProbe::median_work(const WorkPattern& work) {
  std::vector<double> times;
  repeat([&](bool counts) {
    const std::int64_t begin = now_ns();
    for (int piece = 0; piece < work.num_chunks; ++piece) {
      work_of_this_thread().run(work.seconds / work.num_chunks);
    }
    if (counts) times.push_back(seconds_since(begin));
  });
  return median(times);
}

double ExchangeProbe::exposed(const WorkPattern& work) {
  const double whole = median_step(work, true).whole;
  return slowest(std::max(0.0, whole - median_work(work)));
}

double ExchangeProbe::bounce(int link, bool begins) {
  const std::int64_t begin = now_ns();
  if (begins) send(link);
  wait_until([&] { return exchange_.poll(link); },
             [&] {
               return "rank " + std::to_string(communicator_.rank()) + ": ping-pong by '" +
                      std::string(exchange_.name()) + "'";
             });
  exchange_.release(link);
  if (!begins) send(link);
  return 0.5 * seconds_since(begin);
}

// The first of the two takes the link with its lowest number, the second the other end of that.
int ExchangeProbe::link_between(int other, bool begins) const {
  int found = -1;
  for (int link = 0; link < neighbours_.num_links(); ++link) {
    if (!neighbours_.has(link) || neighbours_.rank(link) != other) continue;
    if (found < 0 || (!begins && neighbours_.peer(link) < neighbours_.peer(found))) found = link;
  }
  return found;
}

// Pairs of ranks (parity, parity + 1), (parity + 2, parity + 3), … at the same time, where there is
// a link between them.
ExchangeProbe::Spread ExchangeProbe::ping_pong(int parity) {
  const bool begins = communicator_.rank() % 2 == parity;
  const int link = link_between(communicator_.rank() + (begins ? 1 : -1), begins);
  communicator_.barrier();
  std::vector<double> times;
  repeat([&](bool counts) {
    if (link < 0) return;
    const double half = bounce(link, begins);
    if (counts) times.push_back(half);
  });
  return begins && link >= 0 ? spread_of(times) : Spread{};
}

double ExchangeProbe::half_round_trip() {
  return half_trips().median;
}

ExchangeProbe::Spread ExchangeProbe::half_trips() {
  Spread longest;
  if (!exchange_.allows_uneven_sides()) {
    const double median = both_ways();
    longest = {median, std::max(median, wholes_.p99), std::max(median, wholes_.most)};
  } else {
    for (int parity = 0; parity < std::min(2, communicator_.size() - 1); ++parity) {
      const Spread one = ping_pong(parity);
      longest = {std::max(longest.median, one.median), std::max(longest.p99, one.p99),
                 std::max(longest.most, one.most)};
    }
  }
  return {slowest(longest.median), slowest(longest.p99), slowest(longest.most)};
}

ExchangeCost ExchangeProbe::measure() {
  ExchangeCost cost;
  cost.both_ways = both_ways();
  const Spread half = half_trips();
  cost.half_round_trip = half.median;
  cost.half_p99 = half.p99;
  cost.half_most = half.most;
  const WorkPattern same{both_ways_, kNumPieces};
  const Step overlapped = median_step(same, true);
  const double exposed_same = overlapped.whole - median_work(same);
  const WorkPattern longer{2.0 * both_ways_, 1};
  const double exposed_alone = median_step(longer, false).whole - median_work(longer);
  const auto share_hidden = [&](double exposed) {
    return std::clamp(1.0 - slowest(exposed) / both_ways_, 0.0, 1.0);
  };
  cost.overlap = share_hidden(exposed_same);
  cost.availability = share_hidden(exposed_alone);
  cost.cpu = slowest(overlapped.in_calls);
  return cost;
}

}  // namespace barchan
