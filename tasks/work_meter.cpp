#include <barchan/tasks/work_meter.hpp>

#include <algorithm>
#include <cmath>

namespace barchan {
namespace {

constexpr double kNewShare = 0.5;         // of a window in the smoothed time
constexpr double kPartsOfNs = 64.0;       // of a weight
constexpr double kBeforeMeasured = 20.0;  // ns a particle and step

}  // namespace

void WorkMeter::note(int lane, std::int64_t ns, std::int64_t particles, std::int64_t step) {
  OfLane& of = lanes_[static_cast<std::size_t>(lane)];
  const std::int64_t steps = step - of.step;
  if (steps > 0 && particles > 0 && ns > of.ns) {
    const double each = static_cast<double>(ns - of.ns) /
                        (static_cast<double>(particles) * static_cast<double>(steps));
    of.shortest = of.shortest > 0.0 ? std::min(of.shortest, each) : each;
  }
  of.ns = ns;
  of.step = step;
}

void WorkMeter::end_window() {
  for (OfLane& of : lanes_) {
    if (of.shortest > 0.0)
      of.smoothed =
          of.smoothed > 0.0 ? of.smoothed + kNewShare * (of.shortest - of.smoothed) : of.shortest;
    of.shortest = 0.0;
  }
}

std::int64_t WorkMeter::weight(int lane) const {
  const double ns = lanes_[static_cast<std::size_t>(lane)].smoothed;
  return std::max<std::int64_t>(1, std::llround(kPartsOfNs * (ns > 0.0 ? ns : kBeforeMeasured)));
}

}  // namespace barchan
