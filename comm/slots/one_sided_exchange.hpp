#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include <barchan/comm/base/window.hpp>
#include <barchan/comm/slots/slot_layout.hpp>

namespace barchan {

/// Common to the exchanges that put into the neighbour's slots under one MPI_Win_lock_all.
/// One outbox per channel and link, outside the window: it is free again when post() returns.
class OneSidedExchange : public SlotExchange {
 public:
  using SlotExchange::SlotExchange;
  std::string_view name() const override = 0;
  /// Lets the library move what is under way (Open MPI has no progress thread), and makes puts
  /// visible.
  void progress() final;

 protected:
  void allocate(SlotCapacity capacity) override;
  void retire() override { window_.free(); }
  std::byte* outbox(const MessageKey& key) override { return local(key); }
  std::string transport() const override { return "one-sided " + window_.component(); }

  [[nodiscard]] const Window& window() const { return window_; }
  [[nodiscard]] const SlotLayout& layout() const { return layout_; }
  [[nodiscard]] int target(const MessageKey& key) const { return neighbours().rank(key.link); }
  [[nodiscard]] std::byte* inbox(const MessageKey& key) const {
    return window_.base() + layout_.slot(key);
  }

  /// Memory outside the window for one message per channel and link.
  [[nodiscard]] std::byte* local(const MessageKey& key) { return local_[index(key)].data(); }

  /// This rank's sequence word for messages from key.link, acquired.
  [[nodiscard]] std::uint64_t word(const MessageKey& key) const {
    return std::atomic_ref(*reinterpret_cast<std::uint64_t*>(window_.base() + layout_.word(key)))
        .load(std::memory_order_acquire);
  }
  /// Puts `value` into the receiver's word for this message; not flushed.
  void put_word(const MessageKey& key, std::uint64_t value);

 private:
  Window window_;
  SlotLayout layout_;
  bool is_unified_ = false;
  std::vector<std::vector<std::byte>> local_;
  std::vector<std::uint64_t> word_values_;  // a put's origin must live until it is flushed
};

}  // namespace barchan
