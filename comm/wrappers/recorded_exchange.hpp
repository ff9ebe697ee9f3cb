#pragma once

#include <memory>
#include <vector>

#include <barchan/comm/base/tape.hpp>
#include <barchan/comm/wrappers/wrapped_exchange.hpp>

namespace barchan {

/// Any exchange, with all that it receives recorded on a tape.
class RecordingExchange final : public WrappedExchange {
 public:
  RecordingExchange(std::unique_ptr<Exchange> inner, int num_links, std::shared_ptr<Tape> tape)
      : WrappedExchange(std::move(inner)), num_links_(num_links), tape_(std::move(tape)) {}

  void release(int link) override;
  void begin_bulk(std::span<const std::span<const std::byte>> outgoing) override;
  bool poll_bulk() override;

 private:
  int num_links_;
  std::shared_ptr<Tape> tape_;
  bool is_bulk_recorded_ = true;
};

/// Plays a tape: every message is in as soon as it is looked for, and what is sent goes nowhere. No
/// communication at all.
class ReplayExchange final : public Exchange {
 public:
  /// @pre tape->is_playing()
  ReplayExchange(std::shared_ptr<Tape> tape, const Neighbours& neighbours)
      : tape_(std::move(tape)),
        neighbours_(neighbours),
        out_(static_cast<std::size_t>(neighbours.num_links())),
        bulk_(out_.size()),
        in_(out_.size()),
        is_in_(out_.size()),
        times_(out_.size()) {}

  std::string_view name() const override { return "replay"; }
  void reserve(std::size_t bytes) override;
  std::span<std::byte> outgoing(int link, std::size_t bytes) override;
  void send(int link) override;
  bool poll(int link) override;
  std::span<const std::byte> received(int link) const override {
    return in_[static_cast<std::size_t>(link)];
  }
  void release(int link) override { is_in_[static_cast<std::size_t>(link)] = false; }
  void begin_bulk(std::span<const std::span<const std::byte>> outgoing) override;
  bool poll_bulk() override { return true; }
  std::vector<std::byte>& bulk(int link) override { return bulk_[static_cast<std::size_t>(link)]; }
  std::int64_t bulk_posted(int /*link*/) const override { return 0; }
  ExchangeStats stats() const override { return stats_; }
  HaloTimes halo_times(int link) const override { return times_[static_cast<std::size_t>(link)]; }

 private:
  std::shared_ptr<Tape> tape_;
  Neighbours neighbours_;
  // By link.
  std::vector<std::vector<std::byte>> out_, bulk_;
  std::vector<std::span<const std::byte>> in_;
  std::vector<bool> is_in_;
  std::vector<HaloTimes> times_;
  ExchangeStats stats_{.transport = "memory"};
};

}  // namespace barchan
