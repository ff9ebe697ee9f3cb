#pragma once

#include <cstddef>
#include <string>

#include <barchan/comm/base/mpi_include.hpp>
#include <barchan/core/base/error.hpp>

namespace barchan {

/// An MPI call returned an error code.
class MpiError : public RunError {
 public:
  /// what() reads `MPI_Put failed on rank 3: <the library's text> (code 45)`.
  MpiError(std::string call, int rank, int code);

  [[nodiscard]] const std::string& call() const { return call_; }
  [[nodiscard]] int rank() const { return rank_; }  ///< in MPI_COMM_WORLD; -1 before MPI_Init
  [[nodiscard]] int code() const { return code_; }

 private:
  std::string call_;
  int rank_;
  int code_;
};

[[noreturn]] void throw_mpi_error(int code, const char* call);

/// Holds every MPI return code against MPI_SUCCESS. Errors: MpiError.
inline void check(int code, const char* call) {
  if (code != MPI_SUCCESS) [[unlikely]]
    throw_mpi_error(code, call);
}

/// A byte count as MPI-3 takes it. Errors: RunError above 2 GiB - 1.
int mpi_count(std::size_t bytes);

/// The library's own words for a code.
std::string mpi_error_text(int code);

}  // namespace barchan
