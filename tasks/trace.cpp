#include <barchan/tasks/trace.hpp>

#include <unistd.h>

#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <barchan/comm/topology/clock_offset.hpp>
#include <barchan/core/base/host_name.hpp>
#include <barchan/core/io/text_file.hpp>
#include <barchan/tasks/agree.hpp>

namespace barchan {
namespace {

constexpr std::array<const char*, static_cast<std::size_t>(Trace::Slice::kNum)> kSliceNames{
    "chunk",   "left band", "right band", "send",      "poll",   "wait",
    "rebuild", "migration", "ghosts",     "reduction", "shadows"};
constexpr std::array<const char*, static_cast<std::size_t>(Trace::Counter::kNum)> kCounterNames{
    "exposed per step [us]", "in flight per step [us]"};

/// What the number in a slice says, by its name.
const char* detail_name(Trace::Slice slice) {
  if (slice == Trace::Slice::Send || slice == Trace::Slice::Poll) return "link";
  return "lane";
}

}  // namespace

Trace::Trace(const Communicator& communicator, const Neighbours& neighbours, int num_workers,
             std::size_t num_events)
    : communicator_(communicator),
      neighbours_(neighbours),
      rings_(static_cast<std::size_t>(std::max(1, num_workers))) {
  for (Ring& ring : rings_) ring.events.resize(std::max<std::size_t>(1, num_events));
  begin_offset_ = clock_offset_ns(communicator_);
  begin_ = now_ns();
}

void Trace::put(const Event& event) {
  if (event.step < first_ || event.step > last_) return;
  const int index = tbb::this_task_arena::current_thread_index();
  const auto worker = index < 0 ? 0 : static_cast<std::size_t>(index) % rings_.size();
  Ring& ring = rings_[worker];
  ring.events[ring.num_put++ % ring.events.size()] = event;
}

std::size_t Trace::num_events() const {
  std::size_t sum = 0;
  for (const Ring& ring : rings_) sum += std::min(ring.num_put, ring.events.size());
  return sum;
}

std::size_t Trace::num_lost() const {
  std::size_t sum = 0;
  for (const Ring& ring : rings_) sum += ring.num_put - std::min(ring.num_put, ring.events.size());
  return sum;
}

void Trace::write(const std::string& path) const {
  const std::int64_t end_offset = clock_offset_ns(communicator_);
  const double span = static_cast<double>(std::max<std::int64_t>(1, now_ns() - begin_));
  const double slope = static_cast<double>(end_offset - begin_offset_) / span;
  std::int64_t zero = communicator_.is_root() ? begin_ : 0;
  communicator_.allreduce_max(std::span(&zero, 1));
  const auto of_ranks = communicator_.gather(json_of_rank(slope, begin_offset_ - zero));
  agree(communicator_, [&] {
    if (!communicator_.is_root()) return;
    OutputFile file(path);
    file.write("{\"displayTimeUnit\":\"ns\",\"traceEvents\":[\n");
    for (std::size_t rank = 0; rank < of_ranks.size(); ++rank) {
      file.write(of_ranks[rank]);
      if (rank + 1 < of_ranks.size()) file.write(",\n");
    }
    file.write("\n]}\n");
    file.commit();
  });
}

/// Own clock t reads t + offset + slope·(t − begin) on rank 0's, whose zero is when its trace
/// began.
std::string Trace::json_of_rank(double slope, std::int64_t offset) const {
  std::string text;
  append_names(text);
  const auto on_common = [&](std::int64_t t) {
    return 1e-3 * (static_cast<double>(t + offset) + slope * static_cast<double>(t - begin_));
  };
  for (std::size_t worker = 0; worker < rings_.size(); ++worker) {
    const Ring& ring = rings_[worker];
    const std::size_t kept = std::min(ring.num_put, ring.events.size());
    for (std::size_t n = ring.num_put - kept; n < ring.num_put; ++n) {
      const Event& event = ring.events[n % ring.events.size()];
      append(text, event, static_cast<int>(worker), on_common(event.begin), on_common(event.end));
    }
  }
  return text;
}

void Trace::append_names(std::string& text) const {
  const int rank = communicator_.rank();
  text += fmt::format(
      R"({{"ph":"M","name":"process_name","pid":{0},"args":{{"name":"rank {0} on {1}"}}}})", rank,
      host_name());
  text += fmt::format(
      ",\n"
      R"({{"ph":"M","name":"process_sort_index","pid":{0},"args":{{"sort_index":{0}}}}})",
      rank);
  for (std::size_t worker = 0; worker < rings_.size(); ++worker) {
    text += fmt::format(
        ",\n"
        R"({{"ph":"M","name":"thread_name","pid":{0},"tid":{1},"args":{{"name":"worker {1}"}}}})",
        rank, worker);
  }
}

void Trace::append(std::string& text, const Event& event, int worker, double ts, double end) const {
  const int rank = communicator_.rank();
  const auto out = std::back_inserter(text);
  if (event.kind == Kind::Slice) {
    fmt::format_to(out,
                   ",\n"
                   R"({{"ph":"X","name":"{}","pid":{},"tid":{},"ts":{:.3f},"dur":{:.3f},)"
                   R"("args":{{"step":{},"{}":{}}}}})",
                   kSliceNames[event.name], rank, worker, ts, end - ts, event.step,
                   detail_name(static_cast<Slice>(event.name)), event.detail);
  } else if (event.kind == Kind::Counter) {
    fmt::format_to(out,
                   ",\n"
                   R"({{"ph":"C","name":"{}","pid":{},"ts":{:.3f},"args":{{"us":{:.3f}}}}})",
                   kCounterNames[event.name], rank, ts, 1e-3 * static_cast<double>(event.end));
  } else {
    // A flow is known by its sender, the link that it leaves by, and the step that needs it.
    const bool is_sent = event.kind == Kind::Sent;
    const int sender = is_sent ? rank : neighbours_.rank(event.detail);
    const int from = is_sent ? event.detail : neighbours_.peer(event.detail);
    fmt::format_to(out,
                   ",\n"
                   R"({{"ph":"{}","name":"halo","cat":"halo","id":"{}.{}.{}",{})"
                   R"("pid":{},"tid":{},"ts":{:.3f}}})",
                   is_sent ? "s" : "f", sender, from, event.step, is_sent ? "" : R"("bp":"e",)",
                   rank, worker, ts);
  }
}

}  // namespace barchan
