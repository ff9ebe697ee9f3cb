#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <barchan/comm/base/mpi_include.hpp>
#include <barchan/comm/base/watchdog.hpp>

namespace barchan {

class Tape;

/// A private duplicate of the caller's communicator: our messages never meet the caller's, and
/// errors come back as codes (MPI_ERRORS_RETURN), which are thrown as MpiError. Every member below
/// "collective" is collective over all ranks, and throws WaitError (watchdog.hpp) when another rank
/// never comes. One thread at a time.
class Communicator {
 public:
  /// Duplicates `caller`. Collective. Errors: MpiError; RunError when MPI is not running.
  /// Implicit, so that a caller of the library can pass its own communicator.
  Communicator(MPI_Comm caller);
  static Communicator self() { return Communicator(MPI_COMM_SELF); }  ///< this rank alone
  static Communicator world() { return Communicator(MPI_COMM_WORLD); }
  ~Communicator();
  Communicator(Communicator&& other) noexcept;
  Communicator& operator=(Communicator&& other) noexcept;
  Communicator(const Communicator&) = delete;
  Communicator& operator=(const Communicator&) = delete;

  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] int size() const { return size_; }
  /// Among the ranks that share memory with this one.
  [[nodiscard]] int node_rank() const { return node_rank_; }
  [[nodiscard]] int node_size() const { return node_size_; }
  [[nodiscard]] bool is_root() const { return rank_ == 0; }
  [[nodiscard]] MPI_Comm handle() const { return comm_; }

  /// A tape (tape.hpp) for exchanges and reductions that record what they receive, or play it;
  /// null: none. Local.
  void set_tape(std::shared_ptr<Tape> tape) { tape_ = std::move(tape); }
  [[nodiscard]] Tape* tape() const { return tape_.get(); }

  /// Ends the program on every rank. For errors that only one rank knows of.
  [[noreturn]] void abort(int status) const;

  /// Waits for a request on handle(); MPI's own waits never end when another rank hangs. Local.
  /// Errors: WaitError; this communicator is then not freed.
  void await(MPI_Request request, const std::string& what,
             double limit_seconds = wait_limit()) const;

  // Collective.
  [[nodiscard]] Communicator duplicate() const { return Communicator(comm_); }
  /// The ranks that gave the same `group`, in their order here.
  [[nodiscard]] Communicator split(int group) const;
  void barrier() const;
  void bcast(std::span<std::byte> bytes, int root = 0) const;  ///< same length on every rank
  [[nodiscard]] std::string bcast(std::string text,
                                  int root = 0) const;        ///< any length; the root's text
  void allreduce_sum(std::span<std::int64_t> values) const;   ///< in place, exact
  void allreduce_sum(std::span<std::uint64_t> values) const;  ///< in place, modulo 2^64
  void allreduce_max(std::span<std::int64_t> values) const;
  void allreduce_max(std::span<double> values) const;
  void allreduce_min(std::span<double> values) const;
  [[nodiscard]] bool all_of(bool mine) const;
  [[nodiscard]] bool any_of(bool mine) const;

  /// Byte strings of any length, in rank order, on rank 0; empty elsewhere.
  [[nodiscard]] std::vector<std::vector<std::byte>> gather(std::span<const std::byte> mine) const;
  [[nodiscard]] std::vector<std::string> gather(const std::string& mine) const;
  /// Plain data of all ranks, in rank order, on rank 0; empty elsewhere.
  template <class T>
  [[nodiscard]] std::vector<T> gather_all(std::span<const T> mine) const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<T> all;
    for (const auto& piece : gather(std::as_bytes(mine))) {
      const std::size_t known = all.size();
      all.resize(known + piece.size() / sizeof(T));
      if (!piece.empty()) std::memcpy(all.data() + known, piece.data(), piece.size());
    }
    return all;
  }

  /// One verdict for all: when `error` is not empty on some rank, every rank gets the text of the
  /// lowest such rank; else empty. For work with files: waits for file_wait_limit().
  [[nodiscard]] std::string first_error(const std::string& error) const;

 private:
  void find_node();
  void free() noexcept;

  MPI_Comm comm_ = MPI_COMM_NULL;
  int rank_ = 0;
  int size_ = 1;
  int node_rank_ = 0;
  int node_size_ = 1;
  mutable bool is_given_up_ = false;  ///< a call is under way that will never end
  std::shared_ptr<Tape> tape_;
};

}  // namespace barchan
