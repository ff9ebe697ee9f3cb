#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <barchan/comm/base/communicator.hpp>

namespace barchan {

/// Memory of this rank that the others may write and read: an RAII MPI_Win_allocate, of equal size
/// on every rank. (MPI_Win_create may need process_vm_writev on a node, which containers forbid;
/// dynamic windows are slow and buggy.)
class Window {
 public:
  /// Shared: MPI_Win_allocate_shared, all ranks on one node.
  enum class Memory { Private, Shared };

  Window() = default;
  /// Zeroed memory, seen as zero by everybody when this returns. Collective.
  /// Errors, the same on every rank: InputError with the remedy when this MPI cannot make the
  /// window here.
  Window(const Communicator& communicator, std::size_t bytes, Memory memory = Memory::Private);
  ~Window();
  Window(Window&& other) noexcept;
  Window& operator=(Window&& other) noexcept;
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Collective.
  void free();

  void lock_all();    ///< one passive epoch (MPI_MODE_NOCHECK) until free
  void unlock_all();  ///< before an MPI_Win_fence or a post–start epoch on the same window

  [[nodiscard]] std::byte* base() const { return base_; }
  [[nodiscard]] std::size_t size() const { return bytes_; }
  [[nodiscard]] MPI_Win handle() const { return window_; }
  /// Another rank's memory. @pre Memory::Shared
  [[nodiscard]] std::byte* base_of(int rank) const;

  void put(std::span<const std::byte> bytes, int target, std::size_t offset) const;
  void flush(int target) const;
  void flush_local(int target) const;
  void sync() const;
  /// Whether what lands is seen by loads without sync(), which then only costs (MPI_WIN_UNIFIED).
  [[nodiscard]] bool is_unified() const;

  /// "osc/rdma", "osc/sm", …: the component behind the window, where the library tells.
  [[nodiscard]] std::string component() const;

 private:
  int create(const Communicator& communicator, Memory memory);

  MPI_Win window_ = MPI_WIN_NULL;
  std::byte* base_ = nullptr;
  std::size_t bytes_ = 0;
  bool is_locked_ = false;
  int num_exceptions_ = 0;
};

}  // namespace barchan
