#include <barchan/comm/base/mpi_error.hpp>

#include <limits>
#include <utility>

namespace barchan {
namespace {

bool is_mpi_running() {
  int is_initialized = 0;
  int is_finalized = 0;
  MPI_Initialized(&is_initialized);
  MPI_Finalized(&is_finalized);
  return is_initialized != 0 && is_finalized == 0;
}

std::string describe(const std::string& call, int rank, int code) {
  std::string text = call + " failed";
  if (rank >= 0) text += " on rank " + std::to_string(rank);
  return text + ": " + mpi_error_text(code) + " (code " + std::to_string(code) + ")";
}

}  // namespace

MpiError::MpiError(std::string call, int rank, int code)
    : RunError(describe(call, rank, code)), call_(std::move(call)), rank_(rank), code_(code) {}

void throw_mpi_error(int code, const char* call) {
  int rank = -1;
  if (is_mpi_running()) MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  throw MpiError(call, rank, code);
}

int mpi_count(std::size_t bytes) {
  if (bytes > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw RunError("a message of " + std::to_string(bytes) +
                   " bytes is longer than one MPI call can move (2 GiB - 1): use more ranks");
  }
  return static_cast<int>(bytes);
}

std::string mpi_error_text(int code) {
  if (!is_mpi_running()) return "MPI is not running";
  char text[MPI_MAX_ERROR_STRING] = {};
  int length = 0;
  if (MPI_Error_string(code, text, &length) != MPI_SUCCESS) return "unknown MPI error";
  return {text, static_cast<std::size_t>(length)};
}

}  // namespace barchan
