#pragma once

#include <barchan/comm/base/mpi_error.hpp>

namespace barchan {

/// As long as it lives, its thread is in an MPI call that waits for other ranks and that cannot be
/// polled. When the call takes longer than wait_limit(), a watching thread prints which call it is
/// and ends the process with status 1, and the launcher ends the other ranks: no thread can return
/// from such a call. Costs two uncontended locks; allocates nothing. From any thread.
class CallWatch {
 public:
  /// @param call      a literal
  /// @param patience  in wait limits
  explicit CallWatch(const char* call, double patience = 1.0) noexcept;
  ~CallWatch();
  CallWatch(const CallWatch&) = delete;
  CallWatch& operator=(const CallWatch&) = delete;

 private:
  friend class CallWatcher;
  const char* call_;
  double patience_;
  int rank_;            ///< in MPI_COMM_WORLD; before MPI_Init: not known
  double begin_ = 0.0;  ///< by the watcher's clock [s]
  CallWatch *before_ = nullptr, *after_ = nullptr;
};

/// check(), for a call that waits for other ranks. Errors: MpiError.
template <class Call>
void check_watched(const char* name, Call&& call) {
  int code = MPI_SUCCESS;
  {
    const CallWatch watch(name);
    code = call();
  }
  check(code, name);
}

}  // namespace barchan
