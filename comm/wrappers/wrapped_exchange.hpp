#pragma once

#include <memory>
#include <utility>

#include <barchan/comm/slots/exchange.hpp>

namespace barchan {

/// Base of what stands before another exchange and changes some of it: passes all on.
class WrappedExchange : public Exchange {
 public:
  explicit WrappedExchange(std::unique_ptr<Exchange> inner) : inner_(std::move(inner)) {}

  std::string_view name() const override { return inner_->name(); }
  void reserve(std::size_t bytes) override { inner_->reserve(bytes); }
  std::span<std::byte> outgoing(Side side, std::size_t bytes) override {
    return inner_->outgoing(side, bytes);
  }
  void send(Side side) override { inner_->send(side); }
  bool poll(Side side) override { return inner_->poll(side); }
  std::span<const std::byte> received(Side side) const override { return inner_->received(side); }
  void release(Side side) override { inner_->release(side); }
  void begin_bulk(std::span<const std::byte> to_left,
                  std::span<const std::byte> to_right) override {
    inner_->begin_bulk(to_left, to_right);
  }
  void progress() override { inner_->progress(); }
  bool needs_progress() const override { return inner_->needs_progress(); }
  bool poll_bulk() override { return inner_->poll_bulk(); }
  std::vector<std::byte>& bulk(Side side) override { return inner_->bulk(side); }
  std::int64_t bulk_posted(Side side) const override { return inner_->bulk_posted(side); }
  ExchangeStats stats() const override { return inner_->stats(); }
  HaloTimes halo_times(Side side) const override { return inner_->halo_times(side); }
  bool is_blocking() const override { return inner_->is_blocking(); }
  bool allows_uneven_sides() const override { return inner_->allows_uneven_sides(); }

 private:
  std::unique_ptr<Exchange> inner_;
};

}  // namespace barchan
