#include <barchan/comm/wrappers/delayed_exchange.hpp>

#include <chrono>
#include <thread>
#include <utility>

#include <barchan/core/base/clock.hpp>

namespace barchan {

DelayedExchange::DelayedExchange(std::unique_ptr<Exchange> inner, int num_links,
                                 double max_delay_seconds, std::uint64_t seed)
    : WrappedExchange(std::move(inner)),
      max_delay_seconds_(max_delay_seconds),
      random_(seed, 0),
      shown_at_(static_cast<std::size_t>(num_links)) {}

std::int64_t DelayedExchange::random_delay_ns() {
  return static_cast<std::int64_t>(random_.uniform(0.0, 1e9 * max_delay_seconds_));
}

void DelayedExchange::hold_sometimes() {
  if (random_.bits() % 4 == 0)
    std::this_thread::sleep_for(std::chrono::nanoseconds(random_delay_ns() / 4));
}

void DelayedExchange::send(int link) {
  hold_sometimes();
  WrappedExchange::send(link);
}

bool DelayedExchange::is_shown(std::int64_t& shown_at) {
  if (shown_at == 0) shown_at = now_ns() + random_delay_ns();
  return now_ns() >= shown_at;
}

bool DelayedExchange::poll(int link) {
  return WrappedExchange::poll(link) && is_shown(shown_at_[static_cast<std::size_t>(link)]);
}

void DelayedExchange::release(int link) {
  shown_at_[static_cast<std::size_t>(link)] = 0;
  WrappedExchange::release(link);
}

void DelayedExchange::begin_bulk(std::span<const std::span<const std::byte>> outgoing) {
  hold_sometimes();
  bulk_shown_at_ = 0;
  WrappedExchange::begin_bulk(outgoing);
}

bool DelayedExchange::poll_bulk() {
  return WrappedExchange::poll_bulk() && is_shown(bulk_shown_at_);
}

}  // namespace barchan
