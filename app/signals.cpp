#include <barchan/app/signals.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <csignal>

#include <barchan/tasks/simulation.hpp>

namespace barchan::app {
namespace {

extern "C" void on_signal(int signal) {
  Simulation::request_stop();
  std::signal(signal, SIG_DFL);
}

extern "C" void on_save_signal(int /*signal*/) {
  Simulation::request_checkpoint();
}

}  // namespace

void keep_standard_streams() {
  int fd = 0;
  do fd = ::open("/dev/null", O_RDWR);
  while (fd >= 0 && fd <= STDERR_FILENO);
  if (fd >= 0) ::close(fd);
}

void catch_early_signals() {
  std::signal(SIGUSR1, on_save_signal);
  std::signal(SIGPIPE, SIG_IGN);
}

void catch_signals() {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error like a full disk
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  if (std::signal(SIGHUP, on_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

}  // namespace barchan::app
