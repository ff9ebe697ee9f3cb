#include <barchan/comm/base/communicator.hpp>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <utility>

#include <barchan/comm/base/call_watch.hpp>
#include <barchan/comm/base/mpi_error.hpp>
#include <barchan/comm/base/mpi_session.hpp>
#include <barchan/comm/base/watchdog.hpp>

namespace barchan {
namespace {

constexpr std::size_t kLargestPiece = std::size_t{1} << 30;  // MPI-3 counts are ints
constexpr int kGatherTag = 1;

// Calls move(offset, count) for pieces that fit an MPI count.
template <class Move>
void for_pieces(std::size_t bytes, Move move) {
  for (std::size_t offset = 0; offset < bytes; offset += kLargestPiece) {
    move(offset, mpi_count(std::min(kLargestPiece, bytes - offset)));
  }
}

template <class T>
void allreduce(const Communicator& communicator, std::span<T> values, MPI_Datatype type, MPI_Op op,
               double limit = wait_limit()) {
  MPI_Request request = MPI_REQUEST_NULL;
  check(MPI_Iallreduce(MPI_IN_PLACE, values.data(), mpi_count(values.size()), type, op,
                       communicator.handle(), &request),
        "MPI_Iallreduce");
  communicator.await(request, "an agreement of all ranks between two steps", limit);
}

int allreduce_flag(const Communicator& communicator, bool mine, MPI_Op op) {
  int flag = mine ? 1 : 0;
  allreduce(communicator, std::span(&flag, 1), MPI_INT, op);
  return flag;
}

}  // namespace

Communicator::Communicator(MPI_Comm caller) {
  if (!is_mpi_initialized()) {
    throw RunError(
        "MPI is not running: call MPI_Init_thread with MPI_THREAD_SERIALIZED, or make a "
        "barchan::MpiSession, before using barchan");
  }
  check_watched("MPI_Comm_dup", [&] { return MPI_Comm_dup(caller, &comm_); });
  check(MPI_Comm_set_errhandler(comm_, MPI_ERRORS_RETURN), "MPI_Comm_set_errhandler");
  check(MPI_Comm_rank(comm_, &rank_), "MPI_Comm_rank");
  check(MPI_Comm_size(comm_, &size_), "MPI_Comm_size");
  find_node();
}

Communicator::~Communicator() {
  free();
}

Communicator::Communicator(Communicator&& other) noexcept
    : comm_(std::exchange(other.comm_, MPI_COMM_NULL)),
      rank_(other.rank_),
      size_(other.size_),
      node_rank_(other.node_rank_),
      node_size_(other.node_size_),
      is_given_up_(other.is_given_up_),
      tape_(std::move(other.tape_)) {}

Communicator& Communicator::operator=(Communicator&& other) noexcept {
  if (this == &other) return *this;
  free();
  comm_ = std::exchange(other.comm_, MPI_COMM_NULL);
  rank_ = other.rank_;
  size_ = other.size_;
  node_rank_ = other.node_rank_;
  node_size_ = other.node_size_;
  is_given_up_ = other.is_given_up_;
  tape_ = std::move(other.tape_);
  return *this;
}

void Communicator::free() noexcept {
  const bool may_free = comm_ != MPI_COMM_NULL && is_mpi_initialized() && !is_given_up_;
  if (may_free) {
    const CallWatch watch("MPI_Comm_free");
    MPI_Comm_free(&comm_);
  }
  comm_ = MPI_COMM_NULL;
}

void Communicator::find_node() {
  MPI_Comm node = MPI_COMM_NULL;
  check_watched("MPI_Comm_split_type", [&] {
    return MPI_Comm_split_type(comm_, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &node);
  });
  check(MPI_Comm_rank(node, &node_rank_), "MPI_Comm_rank");
  check(MPI_Comm_size(node, &node_size_), "MPI_Comm_size");
  check_watched("MPI_Comm_free", [&] { return MPI_Comm_free(&node); });
}

void Communicator::abort(int status) const {
  MPI_Abort(comm_, status);
  std::abort();
}

void Communicator::await(MPI_Request request, const std::string& what, double limit_seconds) const {
  const auto has_come = [&] {
    int is_done = 0;
    check(MPI_Test(&request, &is_done, MPI_STATUS_IGNORE), "MPI_Test");
    return is_done != 0;
  };
  is_given_up_ = true;
  wait_until(
      has_come, [&] { return "rank " + std::to_string(rank_) + ": " + what; }, limit_seconds);
  is_given_up_ = false;
}

Communicator Communicator::split(int group) const {
  MPI_Comm part = MPI_COMM_NULL;
  check_watched("MPI_Comm_split", [&] { return MPI_Comm_split(comm_, group, rank_, &part); });
  Communicator mine(part);
  check_watched("MPI_Comm_free", [&] { return MPI_Comm_free(&part); });
  return mine;
}

void Communicator::barrier() const {
  MPI_Request request = MPI_REQUEST_NULL;
  check(MPI_Ibarrier(comm_, &request), "MPI_Ibarrier");
  await(request, "all ranks to reach the same point");
}

void Communicator::bcast(std::span<std::byte> bytes, int root) const {
  for_pieces(bytes.size(), [&](std::size_t offset, int count) {
    MPI_Request request = MPI_REQUEST_NULL;
    check(MPI_Ibcast(bytes.data() + offset, count, MPI_BYTE, root, comm_, &request), "MPI_Ibcast");
    await(request, "what rank " + std::to_string(root) + " tells all");
  });
}

std::string Communicator::bcast(std::string text, int root) const {
  std::uint64_t length = text.size();
  bcast(std::as_writable_bytes(std::span(&length, 1)), root);
  text.resize(length);
  bcast(std::as_writable_bytes(std::span(text.data(), text.size())), root);
  return text;
}

void Communicator::allreduce_sum(std::span<std::int64_t> values) const {
  allreduce(*this, values, MPI_INT64_T, MPI_SUM);
}
void Communicator::allreduce_sum(std::span<std::uint64_t> values) const {
  allreduce(*this, values, MPI_UINT64_T, MPI_SUM);
}
void Communicator::allreduce_max(std::span<std::int64_t> values) const {
  allreduce(*this, values, MPI_INT64_T, MPI_MAX);
}
void Communicator::allreduce_max(std::span<double> values) const {
  allreduce(*this, values, MPI_DOUBLE, MPI_MAX);
}
void Communicator::allreduce_min(std::span<double> values) const {
  allreduce(*this, values, MPI_DOUBLE, MPI_MIN);
}

bool Communicator::all_of(bool mine) const {
  return allreduce_flag(*this, mine, MPI_LAND) != 0;
}
bool Communicator::any_of(bool mine) const {
  return allreduce_flag(*this, mine, MPI_LOR) != 0;
}

std::vector<std::vector<std::byte>> Communicator::gather(std::span<const std::byte> mine) const {
  const std::uint64_t length = mine.size();
  std::vector<std::uint64_t> lengths(is_root() ? static_cast<std::size_t>(size_) : 0);
  MPI_Request request = MPI_REQUEST_NULL;
  check(MPI_Igather(&length, 1, MPI_UINT64_T, lengths.data(), 1, MPI_UINT64_T, 0, comm_, &request),
        "MPI_Igather");
  await(request, "what all ranks send to rank 0");
  if (!is_root()) {
    for_pieces(mine.size(), [&](std::size_t offset, int count) {
      check(MPI_Isend(mine.data() + offset, count, MPI_BYTE, 0, kGatherTag, comm_, &request),
            "MPI_Isend");
      await(request, "rank 0 to receive its part");
    });
    return {};
  }
  std::vector<std::vector<std::byte>> all(lengths.size());
  all[0].assign(mine.begin(), mine.end());
  for (int source = 1; source < size_; ++source) {
    auto& theirs = all[static_cast<std::size_t>(source)];
    theirs.resize(lengths[static_cast<std::size_t>(source)]);
    for_pieces(theirs.size(), [&](std::size_t offset, int count) {
      check(MPI_Irecv(theirs.data() + offset, count, MPI_BYTE, source, kGatherTag, comm_, &request),
            "MPI_Irecv");
      await(request, "the part of rank " + std::to_string(source));
    });
  }
  return all;
}

std::vector<std::string> Communicator::gather(const std::string& mine) const {
  std::vector<std::string> texts;
  for (const auto& bytes : gather(std::as_bytes(std::span(mine.data(), mine.size())))) {
    std::string text(bytes.size(), '\0');
    std::copy(bytes.begin(), bytes.end(),
              std::as_writable_bytes(std::span(text.data(), text.size())).begin());
    texts.push_back(std::move(text));
  }
  return texts;
}

std::string Communicator::first_error(const std::string& error) const {
  int lowest = error.empty() ? std::numeric_limits<int>::max() : rank_;
  allreduce(*this, std::span(&lowest, 1), MPI_INT, MPI_MIN, file_wait_limit());
  if (lowest == std::numeric_limits<int>::max()) return {};
  return bcast(error, lowest);
}

}  // namespace barchan
