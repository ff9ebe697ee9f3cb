// The forwarder of the network lab: reads packets from one TUN device per emulated host, holds each
// until its time by the model in wire.hpp, and writes it to the device of the receiver. Run by
// `netlab`; says "ready" on standard output once the devices netlab1 ... netlabN exist in its
// network namespace; ends on SIGTERM.
#include "tun.hpp"
#include "wire.hpp"

#include <poll.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <queue>
#include <string_view>

namespace netlab {
namespace {

volatile std::sig_atomic_t stop_asked = 0;

struct Options {
  int hosts = 2;
  WireOptions wire;
  Nanoseconds spin = 0;  ///< polls so long before a release, rather than to be late
  bool offload = true;
  std::string stats;  ///< file for the figures of the run; empty: none
};

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

struct Stats {
  std::uint64_t packets = 0, bytes = 0, dropped = 0, foreign = 0, sleeps = 0;
  std::array<std::uint64_t, 2001>
      late_us{};  ///< how far behind its time a packet left; the last bin: or more
  Nanoseconds late_max = 0;
  Nanoseconds timer_lag = 0;  ///< mean, as learnt

  int late_quantile(double share) const {
    std::uint64_t below = 0;
    for (std::size_t bin = 0; bin < late_us.size(); ++bin) {
      below += late_us[bin];
      if (double(below) >= share * double(packets)) return int(bin);
    }
    return int(late_us.size());
  }
};

Nanoseconds now_ns() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return Nanoseconds{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

class Forwarder {
 public:
  explicit Forwarder(const Options& options)
      : x_options(options), x_wire(options.hosts, options.wire), x_scratch(1 << 17) {
    sigprocmask(SIG_SETMASK, nullptr, &x_open_signals);
    sigdelset(&x_open_signals, SIGTERM);
    const double per_byte = options.wire.ns_per_byte;
    for (int host = 0; host < options.hosts; ++host) {
      const std::string device = "netlab" + std::to_string(host + 1);
      x_polls.push_back({open_tun(device, options.offload), POLLIN, 0});
      announce_speed(device, per_byte > 0 ? 8e9 / per_byte : 1e11);
    }
  }

  void run() {
    while (!stop_asked) {
      release_due();
      if (!wait()) continue;
      for (int host = 0; host < x_options.hosts; ++host)
        if (x_polls[host].revents & POLLIN) take_from(host);
    }
  }

  const Stats& stats() const { return x_stats; }

 private:
  /// Sleeps until a packet comes or the next release is near. True when there is something to read.
  /// Timers are late by a time that depends on the machine: the sleep is shortened by the mean of
  /// it.
  bool wait() {
    if (x_line.empty()) {
      ++x_stats.sleeps;
      return ppoll(x_polls.data(), x_polls.size(), nullptr, &x_open_signals) > 0;
    }
    const Nanoseconds start = now_ns();
    const Nanoseconds left = x_line.top().due - start - x_options.spin - x_stats.timer_lag;
    const Nanoseconds sleep = std::max<Nanoseconds>(left, 0);
    const timespec timeout{sleep / 1'000'000'000, sleep % 1'000'000'000};
    const bool has_input = ppoll(x_polls.data(), x_polls.size(), &timeout, &x_open_signals) > 0;
    if (sleep > 0) {
      ++x_stats.sleeps;
      constexpr Nanoseconds largest = 50'000;  // a stall of the machine is no lag of timers
      if (!has_input)
        x_stats.timer_lag += (std::min(now_ns() - start - sleep, largest) - x_stats.timer_lag) / 16;
    }
    return has_input;
  }

  void take_from(int host) {
    constexpr int batch = 64;  // then the other hosts get their turn
    for (int n = 0; n < batch; ++n) {
      const ssize_t size = read(x_polls[host].fd, x_scratch.data(), x_scratch.size());
      if (size <= 0) return;
      hold(host, Frame(x_scratch.data(), static_cast<std::size_t>(size)),
           static_cast<std::size_t>(size));
      release_due();
    }
  }

  void hold(int from, const Frame& frame, std::size_t size) {
    Packet packet;
    packet.to = frame.receiver(x_options.hosts);
    if (packet.to < 0) {
      ++x_stats.foreign;
      return;
    }
    packet.wire_bytes = frame.wire_bytes();
    const auto due = x_wire.leave(from, packet.to, frame.flow(), packet.wire_bytes, now_ns());
    if (!due) {
      ++x_stats.dropped;
      return;
    }
    packet.due = *due;
    packet.order = x_order++;
    packet.frame.assign(x_scratch.data(), x_scratch.data() + size);
    x_line.push(std::move(packet));
  }

  void release_due() {
    while (!x_line.empty()) {
      const Nanoseconds now = now_ns();
      if (x_line.top().due > now) return;
      Packet packet =
          std::move(const_cast<Packet&>(x_line.top()));  // the keys stay as they are until the pop
      x_line.pop();
      if (!packet.past_port && !pass_port(packet)) continue;
      if (packet.due > now)
        x_line.push(std::move(packet));
      else
        deliver(packet, now);
    }
  }

  bool pass_port(Packet& packet) {
    const auto due = x_wire.arrive(packet.to, packet.wire_bytes, packet.due);
    x_stats.dropped += !due;
    packet.due = due.value_or(packet.due);
    packet.past_port = true;
    return due.has_value();
  }

  void deliver(const Packet& packet, Nanoseconds now) {
    if (write(x_polls[packet.to].fd, packet.frame.data(), packet.frame.size()) < 0) {
      ++x_stats.dropped;
      return;
    }
    const Nanoseconds late = now - packet.due;
    x_stats.late_max = std::max(x_stats.late_max, late);
    ++x_stats.late_us[std::min<std::size_t>(std::size_t(late / 1000), x_stats.late_us.size() - 1)];
    ++x_stats.packets;
    x_stats.bytes += packet.frame.size() - Frame::header_size;
  }

  Options x_options;
  Wire x_wire;
  Stats x_stats;
  sigset_t x_open_signals{};
  std::vector<pollfd> x_polls;
  std::priority_queue<Packet, std::vector<Packet>, Later> x_line;
  std::vector<char> x_scratch;
  std::uint64_t x_order = 0;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string_view key = argv[i];
    const char* value = argv[i + 1];
    if (key == "--hosts")
      options.hosts = std::atoi(value);
    else if (key == "--delay-ns")
      options.wire.delay = std::atoll(value);
    else if (key == "--jitter-ns")
      options.wire.jitter = std::atoll(value);
    else if (key == "--spike-share")
      options.wire.spike_share = std::atof(value);
    else if (key == "--spike-factor")
      options.wire.spike_factor = std::atof(value);
    else if (key == "--rate-bps")
      options.wire.ns_per_byte = std::atof(value) > 0 ? 8e9 / std::atof(value) : 0;
    else if (key == "--queue-bytes")
      options.wire.queue_bytes = std::atof(value);
    else if (key == "--keep-order")
      options.wire.keep_order = std::atoi(value) != 0;
    else if (key == "--seed")
      options.wire.seed = std::strtoull(value, nullptr, 10);
    else if (key == "--spin-ns")
      options.spin = std::atoll(value);
    else if (key == "--offload")
      options.offload = std::atoi(value) != 0;
    else if (key == "--stats")
      options.stats = value;
    else
      throw std::runtime_error("netlab_forwarder: no option " + std::string(key) +
                               "; it is run by netlab");
  }
  return options;
}

/// Ranks that poll keep every core busy: the wire must be able to interrupt them, and wake on time.
void become_urgent() {
  sched_param param{};
  param.sched_priority = 10;
  if (sched_setscheduler(0, SCHED_FIFO, &param) != 0) setpriority(PRIO_PROCESS, 0, -20);
  prctl(PR_SET_TIMERSLACK, 1UL);
  mlockall(MCL_CURRENT | MCL_FUTURE);
}

void write_stats(const std::string& path, const Stats& stats, double seconds) {
  std::FILE* file = path.empty() ? nullptr : std::fopen(path.c_str(), "w");
  if (!file) return;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto cpu = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  std::fprintf(file,
               "{\"seconds\": %.3f, \"cpu_seconds\": %.3f, \"packets\": %llu, \"bytes\": %llu, "
               "\"dropped\": %llu, "
               "\"not_ours\": %llu, \"sleeps\": %llu, \"timer_lag_us\": %.1f, "
               "\"late_us\": {\"p50\": %d, \"p99\": %d, \"max\": %.1f}}\n",
               seconds, cpu(usage.ru_utime) + cpu(usage.ru_stime),
               (unsigned long long)stats.packets, (unsigned long long)stats.bytes,
               (unsigned long long)stats.dropped, (unsigned long long)stats.foreign,
               (unsigned long long)stats.sleeps, 1e-3 * double(stats.timer_lag),
               stats.late_quantile(0.5), stats.late_quantile(0.99), 1e-3 * double(stats.late_max));
  std::fclose(file);
}

}  // namespace
}  // namespace netlab

int main(int argc, char** argv) try {
  using namespace netlab;
  sigset_t mask;
  sigemptyset(&mask);
  sigaddset(&mask, SIGTERM);
  sigaddset(&mask, SIGINT);  // a Ctrl-C in the terminal is for the program; the lab ends after it
  sigprocmask(SIG_BLOCK, &mask, nullptr);
  std::signal(SIGTERM, [](int) { stop_asked = 1; });
  const Options options = parse(argc, argv);
  Forwarder forwarder(options);
  become_urgent();
  std::puts("ready");
  std::fflush(stdout);
  const Nanoseconds start = now_ns();
  forwarder.run();
  write_stats(options.stats, forwarder.stats(), 1e-9 * double(now_ns() - start));
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
