#include <barchan/tasks/step_clock.hpp>

#include <algorithm>

#include <barchan/core/base/clock.hpp>

namespace barchan {

void StepClock::chunk(int lane, int step, std::int64_t begin, std::int64_t end) {
  of(lane).chunks += end - begin;
  if (trace_ != nullptr) trace_->slice(Trace::Slice::Chunk, lane, begin, end, step);
}

void StepClock::chunks_end(int lane) {
  if (num_lanes() > 1) of(lane).idle_since = now_ns();
}

void StepClock::band(int lane, Side side, int step, std::int64_t begin, std::int64_t end) {
  of(lane).bands += end - begin;
  busy_ += end - begin;
  if (trace_ == nullptr) return;
  trace_->slice(side == Side::Left ? Trace::Slice::LeftBand : Trace::Slice::RightBand, lane, begin,
                end, step);
}

void StepClock::sent(int link, const Sending& times, std::int64_t in_exchange) {
  send_ += in_exchange;
  if (next_sent_at_ == 0) next_sent_at_ = times.handed_over;
  if (trace_ == nullptr) return;
  trace_->slice(Trace::Slice::Send, link, times.begin, times.end);
  trace_->sent(link, trace_->step() + 1, times.handed_over);
}

void StepClock::polled(std::int64_t begin, std::span<const int> found, std::int64_t worked) {
  const std::int64_t end = now_ns();
  poll_ += end - begin - worked;
  busy_ += worked;
  if (trace_ == nullptr) return;
  // A slice for each, since polls in vain are many.
  for (const int link : found) trace_->slice(Trace::Slice::Poll, link, begin, end);
}

/// A lane whose chunks were done before others' has been idle since; the wait counts what comes
/// after.
void StepClock::noticed(int link, int lane, std::int64_t posted, bool is_last) {
  const std::int64_t now = now_ns();
  const std::int64_t since = of(lane).idle_since;
  const std::int64_t until = waits_since_ != 0 ? waits_since_ : now;
  if (waits_since_ != 0) posted_ = std::max(posted_, posted);
  if (since != 0 && since < until) {
    wait_ += until - since;
    late_ += std::clamp<std::int64_t>(posted - since, 0, until - since);
  }
  if (has_shadows_) return;
  if (is_last && sent_at_ != 0) flight_ += now - sent_at_;
  if (trace_ != nullptr) trace_->noticed(link, trace_->step(), now);
}

StepClock::Instant StepClock::instant() const {
  return {now_ns(), busy_};
}

void StepClock::begin_wait(const Instant& begin) {
  waits_since_ = begin.at;
  posted_ = 0;
}

void StepClock::end_wait(const Instant& begin, const Instant& end, std::int64_t worked) {
  const std::int64_t waited = end.at - begin.at;
  const std::int64_t all =
      std::max(waited, num_lanes() * waited - (end.busy - begin.busy)) - worked;
  wait_ += all;
  // Of that the share before the last message left its sender.
  const std::int64_t late = std::clamp<std::int64_t>(posted_ - begin.at, 0, waited);
  if (late > 0)
    late_ += static_cast<std::int64_t>(static_cast<double>(all) * static_cast<double>(late) /
                                       static_cast<double>(waited));
  if (trace_ != nullptr) trace_->slice(Trace::Slice::Wait, 0, begin.at, end.at);
}

void StepClock::begin_run() {
  waits_since_ = 0;
  for (OfLane& lane : lanes_) lane.idle_since.store(0, std::memory_order_relaxed);
}

void StepClock::end_run(std::int64_t begin) {
  sent_at_ = next_sent_at_;
  next_sent_at_ = 0;
  if (trace_ != nullptr) count_exposed();
  run_ += now_ns() - begin;
}

void StepClock::count_exposed() {
  const std::int64_t exposed = send_ + poll_ + wait_, now = now_ns();
  trace_->count(Trace::Counter::ExposedMicroseconds, (exposed - exposed_before_) / num_lanes(),
                now);
  trace_->count(Trace::Counter::FlightMicroseconds, flight_ - flight_before_, now);
  exposed_before_ = exposed;
  flight_before_ = flight_;
}

StepTimes StepClock::times() const {
  constexpr double kSecond = 1e-9;  // in nanoseconds
  const double share = kSecond / num_lanes();
  const auto shared = [share](std::int64_t ns) { return share * static_cast<double>(ns); };
  std::int64_t chunks = 0, bands = 0;
  for (const OfLane& lane : lanes_) {
    chunks += lane.chunks;
    bands += lane.bands;
  }
  StepTimes times;
  times.chunks = shared(chunks);
  times.bands = shared(bands - send_);
  times.send = shared(send_);
  times.poll = shared(poll_);
  times.wait = shared(wait_);
  times.late = shared(late_);
  times.run = kSecond * static_cast<double>(run_);
  times.in_flight = kSecond * static_cast<double>(flight_);
  return times;
}

}  // namespace barchan
