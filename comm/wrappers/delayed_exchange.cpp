#include <barchan/comm/wrappers/delayed_exchange.hpp>

#include <chrono>
#include <thread>
#include <utility>

#include <barchan/core/base/clock.hpp>

namespace barchan {

DelayedExchange::DelayedExchange(std::unique_ptr<Exchange> inner, double max_delay_seconds,
                                 std::uint64_t seed)
    : WrappedExchange(std::move(inner)), max_delay_seconds_(max_delay_seconds), random_(seed, 0) {}

std::int64_t DelayedExchange::random_delay_ns() {
  return static_cast<std::int64_t>(random_.uniform(0.0, 1e9 * max_delay_seconds_));
}

void DelayedExchange::hold_sometimes() {
  if (random_.bits() % 4 == 0)
    std::this_thread::sleep_for(std::chrono::nanoseconds(random_delay_ns() / 4));
}

void DelayedExchange::send(Side side) {
  hold_sometimes();
  WrappedExchange::send(side);
}

bool DelayedExchange::is_shown(std::int64_t& shown_at) {
  if (shown_at == 0) shown_at = now_ns() + random_delay_ns();
  return now_ns() >= shown_at;
}

bool DelayedExchange::poll(Side side) {
  return WrappedExchange::poll(side) && is_shown(shown_at_[index_of(side)]);
}

void DelayedExchange::release(Side side) {
  shown_at_[index_of(side)] = 0;
  WrappedExchange::release(side);
}

void DelayedExchange::begin_bulk(std::span<const std::byte> to_left,
                                 std::span<const std::byte> to_right) {
  hold_sometimes();
  bulk_shown_at_ = 0;
  WrappedExchange::begin_bulk(to_left, to_right);
}

bool DelayedExchange::poll_bulk() {
  return WrappedExchange::poll_bulk() && is_shown(bulk_shown_at_);
}

}  // namespace barchan
