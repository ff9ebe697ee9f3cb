// The model of the lab's network: when does a packet that leaves one host arrive at another?
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace netlab {

using Nanoseconds = std::int64_t;

/// What the network does to packets.
struct WireOptions {
  Nanoseconds delay = 0;         ///< one way
  Nanoseconds jitter = 0;        ///< the delay is uniform in [delay − jitter, delay + jitter]
  double spike_share = 0;        ///< share of packets, 0 to 1, whose delay is multiplied ...
  double spike_factor = 1;       ///< ... by this
  double ns_per_byte = 0;        ///< inverse of the rate; 0: no limit
  double queue_bytes = 4 << 20;  ///< a port that holds more drops what comes
  bool keep_order = true;        ///< packets of one flow never overtake each other
  std::uint64_t seed = 1;
};

/// A number in [0, 1). Counter-based: draw n of a link is the same whatever the other links do.
/// Source: Steele, Lea & Flood 2014, SplitMix64, doi:10.1145/2660193.2660195.
inline double draw(std::uint64_t seed, std::uint64_t counter) {
  std::uint64_t z = seed + (counter + 1) * 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
}

/// Ports and lines between the hosts, times by one clock [ns].
///
///   leave()  -> port out of the sender: bytes / rate, one packet after the other
///            -> the line: delay, jitter, spike; in order per flow
///   arrive() -> port into the receiver: bytes / rate again, overlapped with the first
///               (cut-through), so that only several senders to one receiver queue there
///
/// Both return the time of the packet's last bit, or nothing when a full port drops it.
class Wire {
 public:
  Wire(int hosts, const WireOptions& options)
      : x_options(options), x_hosts(hosts), x_out_free(hosts), x_in_free(hosts) {}

  std::optional<Nanoseconds> leave(int from, int to, std::uint64_t flow, double bytes,
                                   Nanoseconds now) {
    Nanoseconds& free = x_out_free[from];
    if (is_full(free - now)) return std::nullopt;
    free = std::max(free, now) + Nanoseconds(bytes * x_options.ns_per_byte);
    const Nanoseconds due = free + line_delay(from, to);
    if (!x_options.keep_order) return due;
    Nanoseconds& last = x_flow_last[flow];
    return last = std::max(last, due);
  }

  std::optional<Nanoseconds> arrive(int to, double bytes, Nanoseconds due) {
    Nanoseconds& free = x_in_free[to];
    if (is_full(free - due)) return std::nullopt;
    return free = std::max(due, free + Nanoseconds(bytes * x_options.ns_per_byte));
  }

 private:
  bool is_full(Nanoseconds backlog) const {
    return x_options.ns_per_byte > 0 &&
           double(backlog) > x_options.queue_bytes * x_options.ns_per_byte;
  }

  Nanoseconds line_delay(int from, int to) {
    const auto link = static_cast<std::uint64_t>(from * x_hosts + to);
    const std::uint64_t seed = (x_options.seed << 20) + link;
    const std::uint64_t count = x_drawn[link]++;
    double delay = double(x_options.delay);
    if (x_options.jitter > 0) delay += double(x_options.jitter) * (2 * draw(seed, 2 * count) - 1);
    const bool is_spike =
        x_options.spike_share > 0 && draw(seed, 2 * count + 1) < x_options.spike_share;
    return std::max<Nanoseconds>(0, Nanoseconds(is_spike ? delay * x_options.spike_factor : delay));
  }

  WireOptions x_options;
  int x_hosts;
  std::vector<Nanoseconds> x_out_free, x_in_free;  ///< when a host's port is next idle
  std::map<std::uint64_t, Nanoseconds> x_flow_last;
  std::map<std::uint64_t, std::uint64_t> x_drawn;
};

}  // namespace netlab
