#include <barchan/app/experiments/programs.hpp>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <thread>

#include <barchan/app/experiments/axes.hpp>
#include <barchan/core/base/error.hpp>

namespace fs = std::filesystem;

namespace barchan::app {
namespace {

constexpr int kNoSuchProgram = 127;  // as a shell says it
constexpr int kGraceSeconds = 20;    // between asking a program to end and killing it

volatile std::sig_atomic_t interrupted = 0;

extern "C" void on_interrupt(int /*signal*/) {
  interrupted = 1;
}

[[noreturn]] void refuse_to_start() {
  throw RunError(std::string("no process can be started: ") + std::strerror(errno));
}

[[noreturn]] void become(const std::vector<std::string>& words, const std::string& log) {
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  const int nothing = ::open("/dev/null", O_RDONLY);
  if (file < 0 || nothing < 0) ::_exit(kNoSuchProgram);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(file, STDOUT_FILENO);
  ::dup2(file, STDERR_FILENO);
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  ::execvp(arguments.front(), arguments.data());
  ::_exit(kNoSuchProgram);
}

/// Of a child that has ended: its exit status, or 128 and its signal, as a shell says it.
int exit_status(int status) {
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

/// Waits; once interrupted, asks the program to end, and kills it when it does not.
/// @return  as exit_status
int await(pid_t child) {
  int status = 0, tenths = 0;
  while (true) {
    const pid_t done = ::waitpid(child, &status, interrupted != 0 ? WNOHANG : 0);
    if (done == child) return exit_status(status);
    if (done < 0 && errno != EINTR) return 1;
    if (interrupted == 0) continue;
    if (tenths == 0) ::kill(child, SIGTERM);
    if (++tenths == 10 * kGraceSeconds) ::kill(child, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

double seconds_of(int who) {
  rusage usage{};
  ::getrusage(who, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace

std::string own_path() {
  std::error_code failed;
  return fs::read_symlink("/proc/self/exe", failed).string();
}

bool is_program(const std::string& path) {
  std::error_code failed;
  return fs::is_regular_file(path, failed) && ::access(path.c_str(), X_OK) == 0;
}

std::string find_program(const std::string& name) {
  if (name.find('/') != std::string::npos) return is_program(name) ? name : "";
  const char* path = std::getenv("PATH");
  for (const std::string& folder : split(path == nullptr ? "" : path, ':')) {
    const std::string file = (folder.empty() ? "." : folder) + "/" + name;
    if (is_program(file)) return file;
  }
  return {};
}

int run_for_output(const std::vector<std::string>& words, std::string& output) {
  int ends[2];
  if (::pipe(ends) != 0) refuse_to_start();
  const pid_t child = ::fork();
  if (child < 0) refuse_to_start();
  if (child == 0) {
    ::close(ends[0]);
    become(words, "/dev/fd/" + std::to_string(ends[1]));
  }
  ::close(ends[1]);
  char buffer[4096];
  for (ssize_t got = 0; (got = ::read(ends[0], buffer, sizeof buffer)) > 0;)
    output.append(buffer, static_cast<std::size_t>(got));
  ::close(ends[0]);
  return await(child);
}

Programs::Programs() {
  struct sigaction action {};
  action.sa_handler = on_interrupt;  // without SA_RESTART: waiting ends
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::sigaction(signal, &action, nullptr);
}

bool Programs::is_interrupted() {
  return interrupted != 0;
}

int Programs::run(const std::vector<std::string>& words, const std::string& log) {
  const pid_t child = ::fork();
  if (child < 0) refuse_to_start();
  if (child == 0) become(words, log);
  return await(child);
}

OtherWork::OtherWork() : begin_(now()) {}

OtherWork::Seconds OtherWork::now() {
  Seconds seconds;
  seconds.wall =
      std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  seconds.own = seconds_of(RUSAGE_SELF) + seconds_of(RUSAGE_CHILDREN);
  std::ifstream file("/proc/stat");
  std::string cpu;
  double user = 0, nice = 0, system = 0, idle = 0, io = 0, irq = 0, soft = 0;
  if (file >> cpu >> user >> nice >> system >> idle >> io >> irq >> soft)
    seconds.busy =
        (user + nice + system + irq + soft) / static_cast<double>(::sysconf(_SC_CLK_TCK));
  return seconds;
}

double OtherWork::cores() const {
  const Seconds end = now();
  const double wall = end.wall - begin_.wall;
  if (wall <= 0.0 || end.busy == 0.0) return 0.0;
  return std::max(0.0, (end.busy - begin_.busy) - (end.own - begin_.own)) / wall;
}

}  // namespace barchan::app
