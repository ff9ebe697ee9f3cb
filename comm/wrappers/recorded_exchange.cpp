#include <barchan/comm/wrappers/recorded_exchange.hpp>

#include <algorithm>

#include <barchan/core/base/clock.hpp>

namespace barchan {
void RecordingExchange::release(int link) {
  tape_->record(Tape::halo_channel(link), WrappedExchange::received(link));
  WrappedExchange::release(link);
}

void RecordingExchange::begin_bulk(std::span<const std::span<const std::byte>> outgoing) {
  is_bulk_recorded_ = false;
  WrappedExchange::begin_bulk(outgoing);
}

bool RecordingExchange::poll_bulk() {
  if (!WrappedExchange::poll_bulk()) return false;
  if (is_bulk_recorded_) return true;
  for (int link = 0; link < num_links_; ++link)
    tape_->record(Tape::bulk_channel(link), WrappedExchange::bulk(link));
  is_bulk_recorded_ = true;
  return true;
}

void ReplayExchange::reserve(std::size_t bytes) {
  for (int link = 0; link < neighbours_.num_links(); ++link) {
    auto& out = out_[static_cast<std::size_t>(link)];
    if (neighbours_.has(link)) out.resize(std::max(out.size(), bytes));
  }
}

std::span<std::byte> ReplayExchange::outgoing(int link, std::size_t bytes) {
  auto& out = out_[static_cast<std::size_t>(link)];
  out.resize(std::max(out.size(), bytes));
  return {out.data(), bytes};
}

void ReplayExchange::send(int link) {
  times_[static_cast<std::size_t>(link)].sent = now_ns();
}

bool ReplayExchange::poll(int link) {
  if (is_in_[static_cast<std::size_t>(link)]) return true;
  if (!neighbours_.has(link)) return false;
  in_[static_cast<std::size_t>(link)] = tape_->next(Tape::halo_channel(link));
  is_in_[static_cast<std::size_t>(link)] = true;
  times_[static_cast<std::size_t>(link)].posted = times_[static_cast<std::size_t>(link)].noticed =
      now_ns();
  return true;
}

void ReplayExchange::begin_bulk(std::span<const std::span<const std::byte>> /*outgoing*/) {
  for (int link = 0; link < neighbours_.num_links(); ++link) {
    const auto played = tape_->next(Tape::bulk_channel(link));
    bulk_[static_cast<std::size_t>(link)].assign(played.begin(), played.end());
  }
}

}  // namespace barchan
