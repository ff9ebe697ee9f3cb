// The forwarder of the network lab: reads packets from one TUN device per emulated host, holds each
// until its time by the model in wire.hpp, and writes it to the device of the receiver; a thread
// per host (port.hpp). Run by `netlab`; says "ready" on standard output once the devices netlab1
// ... netlabN exist in its network namespace; ends on SIGTERM.
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string_view>
#include <thread>

#include "port.hpp"

namespace netlab {
namespace {

struct Options {
  int hosts = 2;
  WireOptions wire;
  bool offload = true, even_price = false;
  std::vector<std::string> cpus;  ///< of each host, such as "0,2"; empty: any
  std::string stats;              ///< file for the figures of the run; empty: none
};

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

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
    else if (key == "--offload")
      options.offload = std::atoi(value) != 0;
    else if (key == "--even-price")
      options.even_price = std::atoi(value) != 0;
    else if (key == "--cpus")
      options.cpus = split(value, ':');
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
}

void stay_on(const std::string& cpus) {
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const std::string& cpu : split(cpus, ',')) CPU_SET(std::atoi(cpu.c_str()), &set);
  sched_setaffinity(0, sizeof set, &set);
}

void make_devices(const Options& options, Network& network) {
  const double per_byte = options.wire.ns_per_byte;
  for (int host = 0; host < options.hosts; ++host) {
    const std::string device = "netlab" + std::to_string(host + 1);
    network.devices.push_back(open_tun(device, options.offload));
    announce_speed(device, per_byte > 0 ? 8e9 / per_byte : 1e11);
  }
}

/// Forwards until SIGTERM. @return the figures of all ports. @pre SIGTERM is blocked
Stats forward(const Options& options, Network& network) {
  std::vector<Port> ports;
  for (int host = 0; host < options.hosts; ++host) ports.emplace_back(network, host);
  std::vector<std::thread> threads;
  for (int host = 0; host < options.hosts; ++host) {
    threads.emplace_back([&, host] {
      become_urgent();
      if (!options.cpus.empty()) stay_on(options.cpus[host]);
      ports[host].run();
    });
  }
  std::puts("ready");
  std::fflush(stdout);
  sigset_t ends;
  sigemptyset(&ends);
  sigaddset(&ends, SIGTERM);
  sigwaitinfo(&ends, nullptr);
  network.stop = true;
  for (std::thread& thread : threads) pthread_kill(thread.native_handle(), SIGTERM);
  Stats sum;
  for (int host = 0; host < options.hosts; ++host) {
    threads[host].join();
    sum.add(ports[host].stats());
  }
  return sum;
}

void write_stats(const std::string& path, const Stats& stats, double seconds) {
  std::FILE* file = path.empty() ? nullptr : std::fopen(path.c_str(), "w");
  if (!file) return;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto cpu = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  std::fprintf(
      file,
      "{\"seconds\": %.3f, \"cpu_seconds\": %.3f, \"packets\": %llu, \"bare\": %llu, \"bytes\": "
      "%llu, "
      "\"dropped\": %llu, "
      "\"not_ours\": %llu, \"sleeps\": %llu, \"timer_lag_us\": %.1f, "
      "\"late_us\": {\"p50\": %d, \"p99\": %d, \"max\": %.1f}}\n",
      seconds, cpu(usage.ru_utime) + cpu(usage.ru_stime), (unsigned long long)stats.packets,
      (unsigned long long)stats.bare, (unsigned long long)stats.bytes,
      (unsigned long long)stats.dropped, (unsigned long long)stats.foreign,
      (unsigned long long)stats.sleeps, 1e-3 * double(stats.timer_lag), stats.late_quantile(0.5),
      stats.late_quantile(0.99), 1e-3 * double(stats.late_max));
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
  std::signal(SIGTERM, [](int) {});
  const Options options = parse(argc, argv);
  Network network(options.hosts, options.wire);
  network.even_price = options.even_price;
  sigprocmask(SIG_SETMASK, nullptr, &network.open_signals);
  sigdelset(&network.open_signals, SIGTERM);
  make_devices(options, network);
  mlockall(MCL_CURRENT | MCL_FUTURE);
  const Nanoseconds start = now_ns();
  const Stats stats = forward(options, network);
  write_stats(options.stats, stats, 1e-9 * double(now_ns() - start));
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
