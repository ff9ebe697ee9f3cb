#pragma once

#include <array>
#include <memory>
#include <vector>

#include <barchan/comm/base/tape.hpp>
#include <barchan/comm/wrappers/wrapped_exchange.hpp>

namespace barchan {

/// Any exchange, with all that it receives recorded on a tape.
class RecordingExchange final : public WrappedExchange {
 public:
  RecordingExchange(std::unique_ptr<Exchange> inner, std::shared_ptr<Tape> tape)
      : WrappedExchange(std::move(inner)), tape_(std::move(tape)) {}

  void release(Side side) override;
  void begin_bulk(std::span<const std::byte> to_left, std::span<const std::byte> to_right) override;
  bool poll_bulk() override;

 private:
  std::shared_ptr<Tape> tape_;
  bool is_bulk_recorded_ = true;
};

/// Plays a tape: every message is in as soon as it is looked for, and what is sent goes nowhere. No
/// communication at all.
class ReplayExchange final : public Exchange {
 public:
  /// @pre tape->is_playing()
  ReplayExchange(std::shared_ptr<Tape> tape, Neighbours neighbours)
      : tape_(std::move(tape)), neighbours_(neighbours) {}

  std::string_view name() const override { return "replay"; }
  void reserve(std::size_t bytes) override;
  std::span<std::byte> outgoing(Side side, std::size_t bytes) override;
  void send(Side side) override;
  bool poll(Side side) override;
  std::span<const std::byte> received(Side side) const override { return in_[index_of(side)]; }
  void release(Side side) override { is_in_[index_of(side)] = false; }
  void begin_bulk(std::span<const std::byte> to_left, std::span<const std::byte> to_right) override;
  bool poll_bulk() override { return true; }
  std::vector<std::byte>& bulk(Side side) override { return bulk_[index_of(side)]; }
  std::int64_t bulk_posted(Side /*side*/) const override { return 0; }
  ExchangeStats stats() const override { return stats_; }
  HaloTimes halo_times(Side side) const override { return times_[index_of(side)]; }

 private:
  std::shared_ptr<Tape> tape_;
  Neighbours neighbours_;
  std::array<std::vector<std::byte>, 2> out_, bulk_;
  std::array<std::span<const std::byte>, 2> in_;
  std::array<bool, 2> is_in_{};
  std::array<HaloTimes, 2> times_{};
  ExchangeStats stats_{.transport = "memory"};
};

}  // namespace barchan
