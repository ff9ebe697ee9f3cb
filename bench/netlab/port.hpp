// One host's port to the network of the lab: what the host sends is held until its time by the
// model in wire.hpp, then written to the device of the receiver.
#pragma once

#include <poll.h>
#include <pthread.h>
#include <sched.h>

#include <array>
#include <atomic>
#include <csignal>
#include <ctime>
#include <mutex>
#include <queue>

#include "tun.hpp"
#include "wire.hpp"

namespace netlab {

inline Nanoseconds now_ns() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return Nanoseconds{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

/// What all ports share.
struct Network {
  Network(int num_hosts, const WireOptions& options) : hosts(num_hosts), wire(num_hosts, options) {}

  int hosts;
  std::vector<int> devices;  ///< of the hosts
  bool even_price = false;   ///< every packet costs a wake-up by a timer, also one that needs none
  sigset_t open_signals{};   ///< the mask under which a port waits
  std::atomic<bool> stop{false};
  std::mutex mutex;  ///< for the wire
  Wire wire;
};

struct Stats {
  std::uint64_t packets = 0, bytes = 0, dropped = 0, foreign = 0, sleeps = 0;
  std::uint64_t bare = 0;  ///< packets that only acknowledge
  std::array<std::uint64_t, 2001>
      late_us{};  ///< how far behind its time a packet left; the last bin: or more
  Nanoseconds late_max = 0;
  Nanoseconds timer_lag = 0;  ///< mean, as learnt; of several ports the largest

  void add(const Stats& other) {
    packets += other.packets;
    bytes += other.bytes;
    dropped += other.dropped;
    foreign += other.foreign;
    sleeps += other.sleeps;
    bare += other.bare;
    for (std::size_t bin = 0; bin < late_us.size(); ++bin) late_us[bin] += other.late_us[bin];
    late_max = std::max(late_max, other.late_max);
    timer_lag = std::max(timer_lag, other.timer_lag);
  }

  int late_quantile(double share) const {
    std::uint64_t below = 0;
    for (std::size_t bin = 0; bin < late_us.size(); ++bin) {
      below += late_us[bin];
      if (double(below) >= share * double(packets)) return int(bin);
    }
    return int(late_us.size());
  }
};

/// Runs on a thread of its own, on the cores of its host: so every host pays for what it sends, as
/// with a network card of its own, and no core pays for all.
class Port {
 public:
  Port(Network& network, int host)
      : x_network(network), x_host(host), x_device(network.devices[host]), x_scratch(1 << 17) {}

  /// Until the network stops; a signal of Network::open_signals makes it look.
  void run() {
    while (!x_network.stop) {
      release_due();
      if (wait()) take();
    }
  }

  const Stats& stats() const { return x_stats; }

 private:
  struct Packet {
    Nanoseconds due = 0;
    std::uint64_t order = 0;  ///< ties leave in the order in which they came
    int to = 0;
    bool past_port = false;  ///< Wire::arrive() is behind it
    double wire_bytes = 0;
    std::vector<char> frame;
  };
  struct Later {
    bool operator()(const Packet& a, const Packet& b) const {
      return a.due != b.due ? a.due > b.due : a.order > b.order;
    }
  };

  /// Sleeps until a packet comes or the next release is near. True when there is something to read.
  /// Timers are late by a time that depends on the machine: the sleep is shortened by the mean of
  /// it.
  bool wait() {
    pollfd device{x_device, POLLIN, 0};
    if (x_line.empty() && x_owes_timer) {
      constexpr timespec shortly{0, 20'000};
      x_owes_timer = false;
      ++x_stats.sleeps;
      return ppoll(&device, 1, &shortly, &x_network.open_signals) > 0;
    }
    if (x_line.empty()) {
      ++x_stats.sleeps;
      return ppoll(&device, 1, nullptr, &x_network.open_signals) > 0;
    }
    const Nanoseconds start = now_ns();
    const Nanoseconds sleep =
        std::max<Nanoseconds>(x_line.top().due - start - x_stats.timer_lag, 0);
    const timespec timeout{sleep / 1'000'000'000, sleep % 1'000'000'000};
    ++x_stats.sleeps;
    const bool has_input = ppoll(&device, 1, &timeout, &x_network.open_signals) > 0;
    constexpr Nanoseconds largest = 50'000;  // a stall of the machine is no lag of timers
    if (has_input) return true;
    x_had_timer = true;
    x_stats.timer_lag += (std::min(now_ns() - start - sleep, largest) - x_stats.timer_lag) / 16;
    return false;
  }

  void take() {
    x_had_timer = false;
    constexpr int batch = 64;
    for (int n = 0; n < batch; ++n) {
      const ssize_t size = read(x_device, x_scratch.data(), x_scratch.size());
      if (size <= 0) return;
      hold(Frame(x_scratch.data(), static_cast<std::size_t>(size)), static_cast<std::size_t>(size));
      release_due();
    }
  }

  void hold(const Frame& frame, std::size_t size) {
    Packet packet;
    packet.to = frame.receiver(x_network.hosts);
    if (packet.to < 0) {
      ++x_stats.foreign;
      return;
    }
    packet.wire_bytes = frame.wire_bytes();
    x_stats.bare += frame.is_bare() ? 1 : 0;
    const std::lock_guard<std::mutex> lock(x_network.mutex);
    const auto due =
        x_network.wire.leave(x_host, packet.to, frame.flow(), packet.wire_bytes, now_ns());
    if (!due) {
      ++x_stats.dropped;
      return;
    }
    packet.due = *due;
    packet.order = x_order++;
    packet.frame.assign(x_scratch.data(), x_scratch.data() + size);
    x_line.push(std::move(packet));
  }

  /// What is due sooner than a timer could wake this thread leaves at once: early by less than the
  /// timer would be late. To poll until then would take the time from the rank on this core.
  void release_due() {
    while (!x_line.empty()) {
      const Nanoseconds now = now_ns() + x_stats.timer_lag;
      if (x_line.top().due > now) return;
      Packet packet =
          std::move(const_cast<Packet&>(x_line.top()));  // the keys stay as they are until the pop
      x_line.pop();
      if (!packet.past_port && !pass_port(packet)) continue;
      if (packet.due > now)
        x_line.push(std::move(packet));
      else
        deliver(packet);
    }
  }

  bool pass_port(Packet& packet) {
    const std::lock_guard<std::mutex> lock(x_network.mutex);
    const auto due = x_network.wire.arrive(packet.to, packet.wire_bytes, packet.due);
    x_stats.dropped += !due;
    packet.due = due.value_or(packet.due);
    packet.past_port = true;
    return due.has_value();
  }

  void deliver(const Packet& packet) {
    if (write(x_network.devices[packet.to], packet.frame.data(), packet.frame.size()) < 0) {
      ++x_stats.dropped;
      return;
    }
    x_owes_timer |= x_network.even_price && !x_had_timer;
    const Nanoseconds late = std::max<Nanoseconds>(now_ns() - packet.due, 0);
    x_stats.late_max = std::max(x_stats.late_max, late);
    ++x_stats.late_us[std::min<std::size_t>(std::size_t(late / 1000), x_stats.late_us.size() - 1)];
    ++x_stats.packets;
    x_stats.bytes += packet.frame.size() - Frame::header_size;
  }

  Network& x_network;
  int x_host;
  int x_device;
  Stats x_stats;
  std::priority_queue<Packet, std::vector<Packet>, Later> x_line;
  std::vector<char> x_scratch;
  std::uint64_t x_order = 0;
  bool x_had_timer = false, x_owes_timer = false;
};

}  // namespace netlab
