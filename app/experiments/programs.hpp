#pragma once

#include <string>
#include <vector>

namespace barchan::app {

[[nodiscard]] std::string own_path();  ///< of the program that runs; empty where nobody knows

/// Whether a file can be started.
[[nodiscard]] bool is_program(const std::string& path);

/// A program in PATH, or as its path says; empty where there is none.
[[nodiscard]] std::string find_program(const std::string& name);

/// Runs a program and appends all that it prints. @return  exit status, or 128 and the signal that
/// ended it. Errors: RunError where no process can be started.
[[nodiscard]] int run_for_output(const std::vector<std::string>& words, std::string& output);

/// Starts programs one after the other. SIGINT, SIGTERM and SIGHUP then end the program that runs,
/// and no further one starts.
class Programs {
 public:
  Programs();

  /// Runs a program to its end; what it prints goes into a file. @return and errors as above
  [[nodiscard]] int run(const std::vector<std::string>& words, const std::string& log);
  [[nodiscard]] static bool is_interrupted();
};

/// Cores that processes other than this one and its children used since this was made. A child
/// counts when it has ended.
class OtherWork {
 public:
  OtherWork();
  [[nodiscard]] double cores() const;  ///< 0 where the system does not tell

 private:
  struct Seconds {
    double wall = 0.0, busy = 0.0, own = 0.0;
  };
  static Seconds now();
  Seconds begin_;
};

}  // namespace barchan::app
