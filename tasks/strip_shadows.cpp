// A strip's links with shadows: between a lane and its messages.
#include <barchan/comm/base/watchdog.hpp>
#include <barchan/core/base/clock.hpp>
#include <barchan/core/brick/cell_order.hpp>
#include <barchan/core/brick/halo.hpp>
#include <barchan/tasks/strip.hpp>

namespace barchan {

template <int Dim>
void Strip<Dim>::begin_step(const StepFrame& frame) {
  for (const auto& beyond : shadows_) {
    if (beyond != nullptr) beyond->begin_step(frame);
  }
}

/// Ghosts behind the neighbour's last shadow.
template <int Dim>
Rows Strip<Dim>::deep_rows(int link) const {
  const LinkEnd& end = end_of(link);
  return slab_behind(lane(end.lane).brick, end.side, map_.shape().depth);
}

/// The next message, if it is in and has room. A blocking exchange is asked only where nothing else
/// helps.
template <int Dim>
bool Strip<Dim>::take_deep(int link) {
  Shadows<Dim>& beyond = *shadows(link);
  if (!beyond.wants_message() || (exchange_->is_blocking() && beyond.is_in()) ||
      !exchange_->poll(link))
    return false;
  beyond.take_message(exchange_->received(link));
  exchange_->release(link);
  const std::int64_t now = now_ns(), number = beyond.messages_in();
  const auto& ring = deep_sent_at_[static_cast<std::size_t>(link)];
  if (number <= beyond.steps())  // the neighbour may be ahead
    flight_ns_ += now - ring[static_cast<std::size_t>(number) % ring.size()];
  if (trace_ != nullptr) trace_->noticed(link, lists_step_ + number, now);
  return true;
}

template <int Dim>
bool Strip<Dim>::poll(int link) {
  Shadows<Dim>* beyond = shadows(link);
  if (beyond == nullptr) return exchange_->poll(link);
  do {
    const std::int64_t begin = now_ns();
    bool has_any = false;
    while (beyond->advance()) has_any = true;
    if (has_any && trace_ != nullptr) trace_->slice(Trace::Slice::Shadows, link, begin, now_ns());
  } while (take_deep(link));
  return beyond->is_in();
}

/// A blocking exchange would wait for what another rank sends only when this one has gone on.
template <int Dim>
void Strip<Dim>::advance_shadows(int link) {
  Shadows<Dim>* beyond = shadows(link);
  if (beyond == nullptr) return;
  if (!exchange_->is_blocking()) return static_cast<void>(poll(link));
  while (beyond->advance()) {
  }
}

template <int Dim>
void Strip<Dim>::progress() {
  exchange_->progress();
  for (int link = 0; link < num_links(); ++link) advance_shadows(link);
}

template <int Dim>
std::int64_t Strip<Dim>::shadow_ns() const {
  std::int64_t n = 0;
  for (const auto& beyond : shadows_) n += beyond != nullptr ? beyond->work_ns() : 0;
  return n;
}

template <int Dim>
void Strip<Dim>::drain(int link) {
  Shadows<Dim>& beyond = *shadows(link);
  const auto advance = [&] {
    while (keeps_level_ && beyond.advance()) {
    }
  };
  while (beyond.awaits_message()) {
    advance();
    wait_until([&] { return exchange_->poll(link); }, [&] { return name_of_halo(link); });
    if (keeps_level_)
      beyond.take_message(exchange_->received(link));
    else
      beyond.drop_message();
    exchange_->release(link);
  }
  advance();
}

template void Strip<2>::begin_step(const StepFrame&);
template void Strip<3>::begin_step(const StepFrame&);
template Rows Strip<2>::deep_rows(int) const;
template Rows Strip<3>::deep_rows(int) const;
template bool Strip<2>::take_deep(int);
template bool Strip<3>::take_deep(int);
template bool Strip<2>::poll(int);
template bool Strip<3>::poll(int);
template void Strip<2>::advance_shadows(int);
template void Strip<3>::advance_shadows(int);
template void Strip<2>::progress();
template void Strip<3>::progress();
template std::int64_t Strip<2>::shadow_ns() const;
template std::int64_t Strip<3>::shadow_ns() const;
template void Strip<2>::drain(int);
template void Strip<3>::drain(int);

}  // namespace barchan
