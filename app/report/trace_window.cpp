#include <barchan/app/report/trace_window.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>

namespace barchan::app {
namespace {

constexpr std::size_t kMostSlices = 20000;

struct Slice {
  int rank, worker, name;
  double begin, length;
  std::int64_t step;
};
struct End {
  int rank = -1, worker = 0;
  double at = 0.0;
};
struct Message {
  End sent, noticed;
  std::int64_t step = 0;
};

/// The events of a trace, which has one a line.
class Events {
 public:
  explicit Events(const std::string& path) {
    std::ifstream file(path);
    std::string line;
    try {
      while (std::getline(file, line)) {
        if (!line.starts_with("{\"ph\"")) continue;
        if (line.back() == ',') line.pop_back();
        take(parsed(line));
      }
    } catch (const Json::exception&) {
      slices.clear();
    }
    if (slices.empty())
      throw InputError(SourcePlace{path, 0, 0}, "is not a trace of barchan",
                       "run with --trace, or remove the file");
  }

  std::vector<Slice> slices;
  std::map<std::string, Message> messages;  ///< by id
  std::map<std::string, int> names;
  std::map<int, int> workers;  ///< of each rank

 private:
  void take(const Json& event) {
    const std::string kind = event.at("ph");
    const int rank = event.at("pid");
    if (kind == "M") {
      const int worker = event.value("tid", -1);
      workers[rank] = std::max(workers[rank], worker + 1);
    } else if (kind == "X") {
      const int name =
          names.emplace(event.at("name"), static_cast<int>(names.size())).first->second;
      slices.push_back({rank, event.at("tid"), name, event.at("ts"), event.at("dur"),
                        event.at("args").at("step")});
    } else if (kind == "s" || kind == "f") {
      const std::string id = event.at("id");
      Message& message = messages[id];
      message.step = std::strtoll(id.c_str() + id.rfind('.') + 1, nullptr, 10);  // sender.link.step
      (kind == "s" ? message.sent : message.noticed) = {rank, event.at("tid"), event.at("ts")};
    }
  }
};

/// The last steps of which the slices are no more than a page takes.
StepWindow last_steps(const std::vector<Slice>& slices) {
  std::map<std::int64_t, std::size_t> of_step;
  for (const Slice& slice : slices) ++of_step[slice.step];
  const std::int64_t last = of_step.rbegin()->first;
  std::int64_t first = last;
  std::size_t sum = 0;
  for (auto it = of_step.rbegin(); it != of_step.rend(); ++it) {
    sum += it->second;
    if (sum > kMostSlices && it->first != last) break;
    first = it->first;
  }
  return {first, last};
}

double rounded(double microseconds) {
  return std::round(1000.0 * microseconds) / 1000.0;
}

}  // namespace

PageData trace_window(const std::string& path, const std::optional<StepWindow>& steps) {
  Events events(path);
  const StepWindow window = steps ? *steps : last_steps(events.slices);
  const auto is_in = [&](std::int64_t step) {
    return window.first <= step && step <= window.second;
  };
  std::erase_if(events.slices, [&](const Slice& slice) { return !is_in(slice.step); });
  if (events.slices.empty())
    throw InputError(SourcePlace{path, 0, 0},
                     fmt::format("has nothing of steps {} to {}", window.first, window.second),
                     "it has the last steps of the run; leave --steps out");
  std::sort(events.slices.begin(), events.slices.end(),
            [](const Slice& a, const Slice& b) { return a.begin < b.begin; });
  if (events.slices.size() > kMostSlices) events.slices.resize(kMostSlices);
  const double zero = events.slices.front().begin;
  PageData json{{"steps", {events.slices.front().step, events.slices.back().step}}};
  json["workers"] = json["slices"] = json["messages"] = PageData::array();
  for (const auto& [rank, count] : events.workers) json["workers"].push_back(std::max(1, count));
  json["names"] = std::vector<std::string>(events.names.size());
  for (const auto& [name, index] : events.names)
    json["names"][static_cast<std::size_t>(index)] = name;
  for (const Slice& s : events.slices)
    json["slices"].push_back(
        {s.rank, s.worker, s.name, rounded(s.begin - zero), rounded(s.length), s.step});
  for (const auto& [id, m] : events.messages) {
    if (m.sent.rank < 0 || m.noticed.rank < 0 || !is_in(m.step)) continue;
    json["messages"].push_back({m.sent.rank, m.sent.worker, rounded(m.sent.at - zero),
                                m.noticed.rank, m.noticed.worker, rounded(m.noticed.at - zero),
                                m.step});
  }
  return json;
}

}  // namespace barchan::app
