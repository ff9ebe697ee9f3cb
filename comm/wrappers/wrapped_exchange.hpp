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
  std::span<std::byte> outgoing(int link, std::size_t bytes) override {
    return inner_->outgoing(link, bytes);
  }
  void send(int link) override { inner_->send(link); }
  bool poll(int link) override { return inner_->poll(link); }
  std::span<const std::byte> received(int link) const override { return inner_->received(link); }
  void release(int link) override { inner_->release(link); }
  void begin_bulk(std::span<const std::span<const std::byte>> outgoing) override {
    inner_->begin_bulk(outgoing);
  }
  void progress() override { inner_->progress(); }
  bool needs_progress() const override { return inner_->needs_progress(); }
  bool poll_bulk() override { return inner_->poll_bulk(); }
  std::vector<std::byte>& bulk(int link) override { return inner_->bulk(link); }
  std::int64_t bulk_posted(int link) const override { return inner_->bulk_posted(link); }
  ExchangeStats stats() const override { return inner_->stats(); }
  HaloTimes halo_times(int link) const override { return inner_->halo_times(link); }
  bool is_blocking() const override { return inner_->is_blocking(); }
  bool allows_uneven_sides() const override { return inner_->allows_uneven_sides(); }

 private:
  std::unique_ptr<Exchange> inner_;
};

}  // namespace barchan
