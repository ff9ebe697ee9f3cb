#include <barchan/comm/wrappers/recorded_exchange.hpp>

#include <algorithm>

#include <barchan/core/base/clock.hpp>

namespace barchan {
namespace {

int halo_channel(Side side) {
  return side == Side::Left ? Tape::HaloLeft : Tape::HaloRight;
}
int bulk_channel(Side side) {
  return side == Side::Left ? Tape::BulkLeft : Tape::BulkRight;
}

}  // namespace

void RecordingExchange::release(Side side) {
  tape_->record(halo_channel(side), WrappedExchange::received(side));
  WrappedExchange::release(side);
}

void RecordingExchange::begin_bulk(std::span<const std::byte> to_left,
                                   std::span<const std::byte> to_right) {
  is_bulk_recorded_ = false;
  WrappedExchange::begin_bulk(to_left, to_right);
}

bool RecordingExchange::poll_bulk() {
  if (!WrappedExchange::poll_bulk()) return false;
  if (is_bulk_recorded_) return true;
  for (const Side side : kSides) tape_->record(bulk_channel(side), WrappedExchange::bulk(side));
  is_bulk_recorded_ = true;
  return true;
}

void ReplayExchange::reserve(std::size_t bytes) {
  for (const Side side : kSides) {
    auto& out = out_[index_of(side)];
    if (neighbours_.has(side)) out.resize(std::max(out.size(), bytes));
  }
}

std::span<std::byte> ReplayExchange::outgoing(Side side, std::size_t bytes) {
  auto& out = out_[index_of(side)];
  out.resize(std::max(out.size(), bytes));
  return {out.data(), bytes};
}

void ReplayExchange::send(Side side) {
  times_[index_of(side)].sent = now_ns();
}

bool ReplayExchange::poll(Side side) {
  if (is_in_[index_of(side)]) return true;
  if (!neighbours_.has(side)) return false;
  in_[index_of(side)] = tape_->next(halo_channel(side));
  is_in_[index_of(side)] = true;
  times_[index_of(side)].posted = times_[index_of(side)].noticed = now_ns();
  return true;
}

void ReplayExchange::begin_bulk(std::span<const std::byte> /*to_left*/,
                                std::span<const std::byte> /*to_right*/) {
  for (const Side side : kSides) {
    const auto played = tape_->next(bulk_channel(side));
    bulk_[index_of(side)].assign(played.begin(), played.end());
  }
}

}  // namespace barchan
