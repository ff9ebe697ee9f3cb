#include <algorithm>
#include <array>
#include <cstdint>
#include <mutex>

#include <barchan/comm/clock.hpp>
#include <barchan/comm/watchdog.hpp>
#include <barchan/tasks/step_graph.hpp>

// The messages of a step: sent by bands, looked for between chunks, waited for where no chunk is
// left, and the time that this takes.

namespace barchan {

/// @pre comm_mutex_ is held for a band that another rank waits for
template <int Dim>
void StepGraph<Dim>::send(int l, Side side) {
  if (!strip_.is_remote(l, side)) return strip_.send_band(l, side);
  const std::int64_t in_exchange = strip_.send_ns(), begin = now_ns();
  strip_.send_band(l, side);
  const std::int64_t end = now_ns(), spent = strip_.send_ns() - in_exchange;
  send_ns_ += spent;
  if (next_sent_at_ == 0) next_sent_at_ = end - spent;
  if (trace_ == nullptr) return;
  trace_->slice(Trace::Slice::Send, static_cast<int>(side), begin, end);
  trace_->sent(side, trace_->step() + 1, end - spent);
}

template <int Dim>
bool StepGraph<Dim>::may_poll(Side side) const {
  return side == Side::Left || !strip_.scheme_returns() || !strip_.neighbours().has(Side::Left) ||
         left_is_done_;
}

template <int Dim>
bool StepGraph<Dim>::poll_sides() {
  bool all = true;
  for (const Side side : kSides) {
    if (arrived_[index_of(side)]) continue;
    if (!may_poll(side)) continue;
    if (strip_.poll(side))
      notice(side);
    else
      all = false;
  }
  return all;
}

/// A lane whose chunks were done before others' has been idle since; the drain counts what comes
/// after.
template <int Dim>
void StepGraph<Dim>::notice(Side side) {
  const std::int64_t now = now_ns();
  const int lane = side == Side::Left ? 0 : strip_.num_lanes() - 1;
  const std::int64_t since = nodes_[static_cast<std::size_t>(lane)].idle_since;
  const std::int64_t until = drain_begin_ != 0 ? drain_begin_ : now;
  const std::int64_t posted = strip_.posted_at(side);
  if (drain_begin_ != 0) posted_at_ = std::max(posted_at_, posted);
  if (strip_.num_lanes() > 1 && since != 0 && since < until) {
    wait_ns_ += until - since;
    late_ns_ += std::clamp<std::int64_t>(posted - since, 0, until - since);
  }
  arrived_[index_of(side)] = true;
  if (arrived_[0] && arrived_[1] && sent_at_ != 0) flight_ns_ += now - sent_at_;
  if (trace_ != nullptr) trace_->noticed(side, trace_->step(), now);
  if (lanes_left_ >= 0) signal(lane, side, 0);
}

/// On the progress thread. What it finds stays found until a worker looks.
/// @pre comm_mutex_ is held
template <int Dim>
void StepGraph<Dim>::drive() {
  Exchange& exchange = *strip_.exchange();
  if (exchange.is_blocking()) return;
  exchange.progress();
  for (const Side side : kSides) {
    if (!arrived_[index_of(side)] && may_poll(side)) (void)exchange.poll(side);
  }
}

/// In the midst of a lane's chunks: somebody waits, or messages need it to come.
template <int Dim>
bool StepGraph<Dim>::is_poll_of_use() const {
  return lanes_left_ < strip_.num_lanes() ||
         (strip_.exchange() != nullptr && strip_.exchange()->needs_progress());
}

template <int Dim>
void StepGraph<Dim>::try_poll(std::int64_t begin) {
  const bool all_is_in = arrived_[0] && arrived_[1];
  if (all_is_in &&
      (strip_.exchange() == nullptr || driver_ || !strip_.exchange()->needs_progress()))
    return;
  const std::unique_lock<std::mutex> lock(comm_mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return;
  const std::array<bool, 2> before{arrived_[0], arrived_[1]};
  if (all_is_in)
    strip_.exchange()->progress();
  else
    (void)poll_sides();
  const std::int64_t end = now_ns();
  poll_ns_ += end - begin;
  if (trace_ == nullptr) return;
  for (const Side side : kSides) {  // a slice for each, since polls in vain are many
    if (arrived_[index_of(side)] != before[index_of(side)])
      trace_->slice(Trace::Slice::Poll, static_cast<int>(side), begin, end);
  }
}

/// Idle workers: all, but for the time that some spend in bands meanwhile.
template <int Dim>
void StepGraph<Dim>::drain(bool may_leave) {
  if (arrived_[0] && arrived_[1]) return;
  const std::int64_t begin = now_ns(), busy = busy_ns_;
  {
    const std::unique_lock<std::mutex> lock(comm_mutex_);
    drain_begin_ = begin;
    posted_at_ = 0;
  }
  poll_until_in(may_leave);
  const std::int64_t end = now_ns(), waited = end - begin,
                     idle = strip_.num_lanes() * waited - (busy_ns_ - busy);
  const std::unique_lock<std::mutex> lock(comm_mutex_);
  const std::int64_t all = std::max(waited, idle);
  wait_ns_ += all;
  // Of that the share before the last message left its sender.
  const std::int64_t late = std::clamp<std::int64_t>(posted_at_ - begin, 0, waited);
  if (late > 0)
    late_ns_ += static_cast<std::int64_t>(static_cast<double>(all) * static_cast<double>(late) /
                                          static_cast<double>(waited));
  if (trace_ != nullptr) trace_->slice(Trace::Slice::Wait, 0, begin, end);
}

template <int Dim>
void StepGraph<Dim>::poll_until_in(bool may_leave) {
  wait_until(
      [this, may_leave] {
        const std::unique_lock<std::mutex> lock(comm_mutex_, std::try_to_lock);
        return lock.owns_lock() && (poll_sides() || (may_leave && arrived_[0]));
      },
      [this] {
        if (arrived_[0] || arrived_[1])
          return strip_.name_of_halo(arrived_[0] ? Side::Right : Side::Left);
        return strip_.name_of_halo(Side::Left) + ", and " + strip_.name_of_halo(Side::Right);
      });
}

template <int Dim>
void StepGraph<Dim>::await_all() {
  if (arrived_[0] && arrived_[1]) return;
  lanes_left_ = -1;  // notice() must not signal: run() does
  drain(false);
  lanes_left_ = strip_.num_lanes();
}

template class StepGraph<2>;
template class StepGraph<3>;

}  // namespace barchan
