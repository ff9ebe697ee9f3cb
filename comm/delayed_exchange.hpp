#pragma once

#include <array>
#include <memory>
#include <random>

#include <barchan/comm/exchange.hpp>

namespace barchan {

/// Tests only: any exchange behind a network of moods. Hides what has arrived for a random time,
/// per message and side, and now and then holds the rank before a send. Order and content are the
/// inner exchange's.
class DelayedExchange final : public Exchange {
 public:
  DelayedExchange(std::unique_ptr<Exchange> inner, double max_delay_seconds, std::uint64_t seed);

  std::string_view name() const override { return inner_->name(); }
  void reserve(std::size_t bytes) override { inner_->reserve(bytes); }
  std::span<std::byte> outgoing(Side side, std::size_t bytes) override {
    return inner_->outgoing(side, bytes);
  }
  void send(Side side) override;
  bool poll(Side side) override;
  std::span<const std::byte> received(Side side) const override { return inner_->received(side); }
  void release(Side side) override;
  void begin_bulk(std::span<const std::byte> to_left, std::span<const std::byte> to_right) override;
  void progress() override { inner_->progress(); }
  bool needs_progress() const override { return inner_->needs_progress(); }
  bool poll_bulk() override;
  std::vector<std::byte>& bulk(Side side) override { return inner_->bulk(side); }
  std::int64_t bulk_posted(Side side) const override { return inner_->bulk_posted(side); }
  ExchangeStats stats() const override { return inner_->stats(); }
  HaloTimes halo_times(Side side) const override { return inner_->halo_times(side); }
  bool is_blocking() const override { return inner_->is_blocking(); }
  bool allows_uneven_sides() const override { return inner_->allows_uneven_sides(); }

 private:
  std::int64_t random_delay_ns();
  void hold_sometimes();
  bool is_shown(std::int64_t& shown_at);

  std::unique_ptr<Exchange> inner_;
  double max_delay_seconds_;
  std::mt19937_64 random_;
  std::array<std::int64_t, 2> shown_at_{};  // [ns]; 0 = not in yet
  std::int64_t bulk_shown_at_ = 0;
};

}  // namespace barchan
