#include <barchan/comm/base/window.hpp>

#include <cstring>
#include <exception>
#include <utility>

#include <barchan/comm/base/call_watch.hpp>
#include <barchan/comm/base/mpi_error.hpp>
#include <barchan/comm/base/mpi_session.hpp>

namespace barchan {
namespace {

MPI_Info window_hints() {
  MPI_Info hints = MPI_INFO_NULL;
  check(MPI_Info_create(&hints), "MPI_Info_create");
  check(MPI_Info_set(hints, "same_size", "true"), "MPI_Info_set");
  check(MPI_Info_set(hints, "same_disp_unit", "true"), "MPI_Info_set");
  return hints;
}

[[noreturn]] void refuse(const std::string& reason, Window::Memory memory) {
  if (memory == Window::Memory::Shared) {
    throw InputError(
        "this MPI cannot make a window of shared memory: " + reason,
        "with Open MPI allow its component osc/sm, as `--mca osc sm,pt2pt` does; or run "
        "with `--exchange put-inband`, or `isend`, which needs no window");
  }
  throw InputError(
      "this MPI cannot make a window for one-sided communication between these ranks: " + reason,
      "with Open MPI 4 over TCP give mpirun `--mca osc sm,pt2pt` or `--mca osc sm,ucx`; or run "
      "with `--exchange isend` or `--exchange sendrecv`, which need no window");
}

}  // namespace

Window::Window(const Communicator& communicator, std::size_t bytes, Memory memory)
    : bytes_(bytes), num_exceptions_(std::uncaught_exceptions()) {
  const int code = create(communicator, memory);
  const std::string mine = code == MPI_SUCCESS ? std::string{} : mpi_error_text(code);
  const std::string verdict = communicator.first_error(mine);
  if (!verdict.empty()) {
    window_ =
        MPI_WIN_NULL;  // not freed: where it exists, others lack it, and freeing is collective
    refuse(verdict, memory);
  }
  check(MPI_Win_set_errhandler(window_, MPI_ERRORS_RETURN), "MPI_Win_set_errhandler");
  std::memset(base_, 0, bytes_);
  lock_all();
  sync();
  unlock_all();
  communicator.barrier();
}

int Window::create(const Communicator& communicator, Memory memory) {
  MPI_Info hints = window_hints();
  const auto size = static_cast<MPI_Aint>(bytes_);
  const CallWatch watch("MPI_Win_allocate");
  const int code =
      memory == Memory::Shared
          ? MPI_Win_allocate_shared(size, 1, hints, communicator.handle(), &base_, &window_)
          : MPI_Win_allocate(size, 1, hints, communicator.handle(), &base_, &window_);
  check(MPI_Info_free(&hints), "MPI_Info_free");
  return code;
}

Window::~Window() {
  // Freeing waits for the other ranks, who may not come when this one unwinds.
  if (std::uncaught_exceptions() > num_exceptions_ || !is_mpi_initialized()) return;
  try {
    free();
  } catch (const std::exception&) {  // NOLINT(bugprone-empty-catch): nothing is left to be saved
  }
}

Window::Window(Window&& other) noexcept
    : window_(std::exchange(other.window_, MPI_WIN_NULL)),
      base_(std::exchange(other.base_, nullptr)),
      bytes_(std::exchange(other.bytes_, 0)),
      is_locked_(std::exchange(other.is_locked_, false)),
      num_exceptions_(other.num_exceptions_) {}

Window& Window::operator=(Window&& other) noexcept {
  std::swap(window_, other.window_);
  std::swap(base_, other.base_);
  std::swap(bytes_, other.bytes_);
  std::swap(is_locked_, other.is_locked_);
  std::swap(num_exceptions_, other.num_exceptions_);
  return *this;
}

void Window::free() {
  if (window_ == MPI_WIN_NULL) return;
  unlock_all();
  check_watched("MPI_Win_free", [&] { return MPI_Win_free(&window_); });
  base_ = nullptr;
  bytes_ = 0;
}

void Window::lock_all() {
  if (is_locked_) return;
  check_watched("MPI_Win_lock_all", [&] { return MPI_Win_lock_all(MPI_MODE_NOCHECK, window_); });
  is_locked_ = true;
}

void Window::unlock_all() {
  if (!is_locked_) return;
  check_watched("MPI_Win_unlock_all", [&] { return MPI_Win_unlock_all(window_); });
  is_locked_ = false;
}

std::byte* Window::base_of(int rank) const {
  MPI_Aint size = 0;
  int unit = 0;
  std::byte* theirs = nullptr;
  check(MPI_Win_shared_query(window_, rank, &size, &unit, &theirs), "MPI_Win_shared_query");
  return theirs;
}

void Window::put(std::span<const std::byte> bytes, int target, std::size_t offset) const {
  const int count = mpi_count(bytes.size());
  check(MPI_Put(bytes.data(), count, MPI_BYTE, target, static_cast<MPI_Aint>(offset), count,
                MPI_BYTE, window_),
        "MPI_Put");
}

void Window::flush(int target) const {
  check_watched("MPI_Win_flush", [&] { return MPI_Win_flush(target, window_); });
}
void Window::flush_local(int target) const {
  check_watched("MPI_Win_flush_local", [&] { return MPI_Win_flush_local(target, window_); });
}
void Window::sync() const {
  check(MPI_Win_sync(window_), "MPI_Win_sync");
}

bool Window::is_unified() const {
  int* model = nullptr;
  int is_set = 0;
  check(MPI_Win_get_attr(window_, MPI_WIN_MODEL, &model, &is_set), "MPI_Win_get_attr");
  return is_set != 0 && *model == MPI_WIN_UNIFIED;
}

std::string Window::component() const {
  char text[MPI_MAX_OBJECT_NAME] = {};
  int length = 0;
  check(MPI_Win_get_name(window_, text, &length), "MPI_Win_get_name");
  const std::string name(text, static_cast<std::size_t>(length));
  if (const auto end = name.find(" window"); end != std::string::npos)
    return "osc/" + name.substr(0, end);
#ifdef OPEN_MPI
  return "osc/sm";  // the one component of Open MPI that leaves its windows unnamed
#else
  return "window";
#endif
}

}  // namespace barchan
