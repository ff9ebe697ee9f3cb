#include <barchan/tasks/step_tasks.hpp>

#include <algorithm>
#include <utility>

namespace barchan {
namespace {

StepTask begin() {
  return {Work::Begin};
}
StepTask end() {
  return {Work::End};
}
StepTask await() {
  return {Work::Await};
}
StepTask await_right() {
  return {Work::AwaitRight};
}
StepTask chunks(int lane) {
  return {Work::Chunks, lane};
}
StepTask band(int lane, Side side) {
  return {side == Side::Left ? Work::LeftBand : Work::RightBand, lane};
}
StepTask arrived(int link) {
  return {Work::Arrived, link};
}

class Writer {
 public:
  explicit Writer(const GraphShape& shape) : shape_(shape) {}

  StepTasks write() && {
    // Of several that become ready a worker takes up the last one told: its own lane.
    if (awaits_ && !is_lone_) write_await();
    for (int l = 0; l < shape_.num_lanes(); ++l) write_cuts(l);
    for (int l = 0; l < shape_.num_lanes(); ++l) write_lane(l);
    for (int l = 0; l < shape_.num_lanes(); ++l) {
      for (const LaneTie& tie : shape_.ties(l)) {
        if (tie.link >= 0) write_arrival(l, tie);
      }
    }
    return std::move(list_);
  }

 private:
  void write_lane(int l) {
    std::vector<StepTask> chain{begin()};
    if (awaits_ && shape_.is_sequential) chain.push_back(await());
    chain.push_back(chunks(l));
    if (awaits_ && is_lone_ && !shape_.is_sequential) chain.push_back(await());
    if (shape_.has_band(l, Side::Left)) chain.push_back(band(l, Side::Left));
    if (awaits_right_ && is_lone_) chain.push_back(await_right());
    if (shape_.has_band(l, Side::Right)) chain.push_back(band(l, Side::Right));
    chain.push_back(end());
    for (std::size_t n = 1; n < chain.size(); ++n) precedes(chain[n - 1], chain[n]);
    const StepTask last = chain[chain.size() - 2];
    precedes_next(last, chunks(l));
    if (goes_on_) arrow(last, chunks(l), Way::Message, true, "goes on");
  }

  /// In memory, to the lanes beside.
  void write_cuts(int l) {
    for (const LaneTie& tie : shape_.ties(l)) {
      if (tie.link >= 0) continue;
      const LaneTie& back = shape_.ties(tie.lane)[static_cast<std::size_t>(tie.back)];
      precedes_next(band(l, shape_.sending_band(tie)), band(tie.lane, back.side));
    }
  }

  /// Of several lanes; a lone one awaits in its chain.
  void write_await() {
    for (int l = 0; l < shape_.num_lanes() && !shape_.is_sequential; ++l) {
      precedes(chunks(l), await());
      precedes(await(), end());
    }
    if (!awaits_right_) return;
    precedes(await(), await_right());
    precedes(band(0, Side::Left), await_right());
    precedes(await_right(), end());
  }

  void write_arrival(int lane, const LaneTie& tie) {
    const StepTask in = arrived(tie.link);
    precedes(in, band(lane, tie.side));
    message(begin(), in, "after a rebuild");
    for (int l = 0; l < shape_.num_lanes() && !shape_.is_sequential; ++l)
      message(chunks(l), in, "poll");
    message(await(), in, "poll");
    if (awaits_right_ && tie.side == Side::Right) message(await_right(), in, "poll");
  }

  void precedes(const StepTask& from, const StepTask& to) { arrow(from, to, Way::Edge, false, ""); }
  void precedes_next(const StepTask& from, const StepTask& to) {
    arrow(from, to, Way::Edge, true, "");
  }
  void message(const StepTask& from, const StepTask& to, const char* note) {
    arrow(from, to, Way::Message, false, note);
  }
  void arrow(const StepTask& from, const StepTask& to, Way way, bool is_next, const char* note) {
    const StepArrow arrow{index_of_task(from), index_of_task(to), way, is_next, note};
    if (std::find(list_.arrows.begin(), list_.arrows.end(), arrow) == list_.arrows.end())
      list_.arrows.push_back(arrow);
  }
  int index_of_task(const StepTask& task) {
    if (list_.find(task) < 0) list_.tasks.push_back(task);
    return list_.find(task);
  }

  const GraphShape& shape_;
  const bool is_lone_ = shape_.num_lanes() == 1;
  const bool has_left_ = shape_.awaits(Side::Left);
  const bool has_right_ = shape_.awaits(Side::Right);
  const bool awaits_ = has_left_ || has_right_;
  const bool awaits_right_ =
      has_left_ && has_right_ && (shape_.returns() || (is_lone_ && !shape_.is_sequential));
  const bool goes_on_ = !awaits_ && !is_lone_;
  StepTasks list_;
};

}  // namespace

bool GraphShape::has_band(int lane, Side side) const {
  return std::ranges::any_of(
      ties(lane), [&](const LaneTie& tie) { return form == CutForm::Bricks || tie.side == side; });
}

bool GraphShape::is_remote(int lane, Side side) const {
  return std::ranges::any_of(ties(lane), [&](const LaneTie& tie) {
    return tie.link >= 0 && (tie.side == side || sending_band(tie) == side);
  });
}

bool GraphShape::awaits(Side side) const {
  return std::ranges::any_of(lanes, [&](const LaneShape& lane) {
    return std::ranges::any_of(
        lane.ties, [&](const LaneTie& tie) { return tie.link >= 0 && tie.side == side; });
  });
}

int GraphShape::num_links() const {
  int n = 0;
  for (const LaneShape& lane : lanes) {
    for (const LaneTie& tie : lane.ties) n += tie.link >= 0 ? 1 : 0;
  }
  return n;
}

GraphShape graph_shape(CutForm form, const std::vector<std::vector<LaneTie>>& ties) {
  GraphShape shape;
  shape.form = form;
  for (const auto& of_lane : ties) shape.lanes.push_back({1, of_lane});
  return shape;
}

int StepTasks::find(const StepTask& task) const {
  const auto at = std::find(tasks.begin(), tasks.end(), task);
  return at == tasks.end() ? -1 : static_cast<int>(at - tasks.begin());
}

StepTasks step_tasks(const GraphShape& shape) {
  return Writer(shape).write();
}

}  // namespace barchan
