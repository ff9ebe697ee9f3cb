#pragma once

#include <memory>
#include <vector>

#include <barchan/comm/wrappers/wrapped_exchange.hpp>
#include <barchan/core/base/random.hpp>

namespace barchan {

/// Tests only: any exchange behind a network of moods. Hides what has arrived for a random time,
/// per message and link, and now and then holds the rank before a send. Order and content are the
/// inner exchange's.
class DelayedExchange final : public WrappedExchange {
 public:
  DelayedExchange(std::unique_ptr<Exchange> inner, int num_links, double max_delay_seconds,
                  std::uint64_t seed);

  void send(int link) override;
  bool poll(int link) override;
  void release(int link) override;
  void begin_bulk(std::span<const std::span<const std::byte>> outgoing) override;
  bool poll_bulk() override;

 private:
  std::int64_t random_delay_ns();
  void hold_sometimes();
  bool is_shown(std::int64_t& shown_at);

  double max_delay_seconds_;
  CounterRandom random_;
  std::vector<std::int64_t> shown_at_;  // by link [ns]; 0 = not in yet
  std::int64_t bulk_shown_at_ = 0;
};

}  // namespace barchan
