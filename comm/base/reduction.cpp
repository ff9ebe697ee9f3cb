#include <barchan/comm/base/reduction.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <exception>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <barchan/comm/base/mpi_error.hpp>
#include <barchan/comm/base/mpi_session.hpp>
#include <barchan/comm/base/tape.hpp>
#include <barchan/comm/base/watchdog.hpp>

namespace barchan {
namespace {

// A record in words of 8 bytes:   | number of maxima | number of words | maxima ... | sums ... |
constexpr std::size_t kFirstValue = 2;
constexpr int kDirectTag = 2;

double exact_max(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<double>::quiet_NaN();
  return a < b ? b : a;
}

void fold(const std::uint64_t* theirs, std::uint64_t* mine) {
  const std::uint64_t num_maxima = mine[0];
  const std::uint64_t num_words = mine[1];
  for (std::uint64_t word = kFirstValue; word < kFirstValue + num_maxima; ++word) {
    mine[word] = std::bit_cast<std::uint64_t>(
        exact_max(std::bit_cast<double>(theirs[word]), std::bit_cast<double>(mine[word])));
  }
  for (std::uint64_t word = kFirstValue + num_maxima; word < num_words; ++word)
    mine[word] += theirs[word];
}

void fold_records(void* theirs, void* mine, int* num_records, MPI_Datatype* /*record*/) {
  auto* from = static_cast<std::uint64_t*>(theirs);
  auto* into = static_cast<std::uint64_t*>(mine);
  for (int record = 0; record < *num_records; ++record) {
    const std::uint64_t num_words = into[1];
    fold(from, into);
    from += num_words;
    into += num_words;
  }
}

}  // namespace

struct Reduction::State {
  State(const Communicator& caller, std::size_t maxima, std::size_t sums, int num_direct_ranks)
      : communicator(caller.duplicate()),
        num_maxima(maxima),
        num_sums(sums),
        is_direct(communicator.size() <= num_direct_ranks),
        mine(kFirstValue + maxima + sums),
        result(mine.size()),
        result_maxima(maxima),
        result_sums(sums),
        tape(caller.tape()),
        num_exceptions(std::uncaught_exceptions()) {
    if (tape != nullptr) channel = tape->open_channel();
    mine[0] = num_maxima;
    mine[1] = mine.size();
    if (communicator.size() == 1) return;
    if (is_direct) {
      prepare_direct();
    } else {
      prepare_tree();
    }
  }

  void prepare_direct() {
    const int bytes = mpi_count(mine.size() * sizeof(std::uint64_t));
    const auto num_others = static_cast<std::size_t>(communicator.size() - 1);
    theirs.resize(num_others * mine.size());
    requests.assign(2 * num_others, MPI_REQUEST_NULL);
    std::size_t other = 0;
    for (int rank = 0; rank < communicator.size(); ++rank) {
      if (rank == communicator.rank()) continue;
      check(MPI_Recv_init(&theirs[other * mine.size()], bytes, MPI_BYTE, rank, kDirectTag,
                          communicator.handle(), &requests[other]),
            "MPI_Recv_init");
      check(MPI_Send_init(mine.data(), bytes, MPI_BYTE, rank, kDirectTag, communicator.handle(),
                          &requests[num_others + other]),
            "MPI_Send_init");
      ++other;
    }
  }

  void prepare_tree() {
    check(MPI_Type_contiguous(mpi_count(mine.size()), MPI_UINT64_T, &record),
          "MPI_Type_contiguous");
    check(MPI_Type_commit(&record), "MPI_Type_commit");
    check(MPI_Op_create(fold_records, 1, &operation), "MPI_Op_create");
    requests.assign(1, MPI_REQUEST_NULL);
  }

  [[nodiscard]] bool is_played() const { return tape != nullptr && tape->is_playing(); }

  void start() {
    ++number;
    is_in_flight = true;
    if (is_played()) return;
    if (communicator.size() == 1) return;
    if (is_direct) {
      check(MPI_Startall(static_cast<int>(requests.size()), requests.data()), "MPI_Startall");
    } else {
      check(MPI_Iallreduce(mine.data(), result.data(), 1, record, operation, communicator.handle(),
                           requests.data()),
            "MPI_Iallreduce");
    }
  }

  bool has_come() {
    if (communicator.size() == 1 || is_played()) return true;
    int is_there = 0;
    check(MPI_Testall(static_cast<int>(requests.size()), requests.data(), &is_there,
                      MPI_STATUSES_IGNORE),
          "MPI_Testall");
    return is_there != 0;
  }

  /// The ranks whose part has not come, in words; empty where nobody can tell.
  [[nodiscard]] std::string missing() const {
    std::string ranks;
    if (!is_direct || is_played()) return ranks;
    std::size_t other = 0;
    for (int rank = 0; rank < communicator.size(); ++rank) {
      if (rank == communicator.rank()) continue;
      int is_there = 0;
      check(MPI_Request_get_status(requests[other++], &is_there, MPI_STATUS_IGNORE),
            "MPI_Request_get_status");
      if (is_there == 0) ranks += (ranks.empty() ? "rank " : ", rank ") + std::to_string(rank);
    }
    return ranks.empty() ? ranks : " (missing: " + ranks + ")";
  }

  void finish() {
    is_in_flight = false;
    if (is_played()) {
      const auto played = tape->next(channel);
      std::memcpy(result.data(), played.data(), std::min(played.size(), 8 * result.size()));
    } else {
      combine();
    }
    for (std::size_t i = 0; i < num_maxima; ++i)
      result_maxima[i] = std::bit_cast<double>(result[kFirstValue + i]);
    for (std::size_t i = 0; i < num_sums; ++i) {
      result_sums[i] = static_cast<std::int64_t>(result[kFirstValue + num_maxima + i]);
    }
  }

  void combine() {
    if (is_direct || communicator.size() == 1) {
      result = mine;
      for (std::size_t at = 0; at < theirs.size(); at += mine.size())
        fold(&theirs[at], result.data());
    }
    if (tape != nullptr) tape->record(channel, std::as_bytes(std::span(result)));
  }

  void free() {
    if (is_direct) {
      for (MPI_Request& request : requests) MPI_Request_free(&request);
    } else if (operation != MPI_OP_NULL) {
      MPI_Op_free(&operation);
      MPI_Type_free(&record);
    }
  }

  Communicator communicator;
  std::size_t num_maxima;
  std::size_t num_sums;
  bool is_direct;
  bool is_in_flight = false;
  std::uint64_t number = 0;
  std::vector<std::uint64_t> mine;
  std::vector<std::uint64_t> result;
  std::vector<std::uint64_t> theirs;
  std::vector<double> result_maxima;
  std::vector<std::int64_t> result_sums;
  std::vector<MPI_Request> requests;
  MPI_Datatype record = MPI_DATATYPE_NULL;
  MPI_Op operation = MPI_OP_NULL;
  Tape* tape;
  int channel = -1;
  int num_exceptions;
};

Reduction::Reduction(const Communicator& communicator, std::size_t num_maxima, std::size_t num_sums,
                     int num_direct_ranks)
    : state_(std::make_unique<State>(communicator, num_maxima, num_sums, num_direct_ranks)) {}

Reduction::~Reduction() {
  if (!is_mpi_initialized()) return;
  if (state_->is_in_flight) {
    if (std::uncaught_exceptions() > state_->num_exceptions) {
      static_cast<void>(
          state_.release());  // the library still writes into it, and the others may never come
      return;
    }
    try {
      wait();
    } catch (const std::exception&) {
      static_cast<void>(state_.release());
      return;
    }
  }
  state_->free();
}

void Reduction::begin(std::span<const double> maxima, std::span<const std::int64_t> sums) {
  State& state = *state_;
  if (maxima.size() != state.num_maxima || sums.size() != state.num_sums) {
    throw std::logic_error("Reduction::begin: other numbers of values than constructed");
  }
  if (state.is_in_flight) throw std::logic_error("Reduction::begin: the last one is in flight");
  for (std::size_t i = 0; i < maxima.size(); ++i) {
    state.mine[kFirstValue + i] = std::bit_cast<std::uint64_t>(maxima[i] + 0.0);  // -0 becomes +0
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    state.mine[kFirstValue + maxima.size() + i] = static_cast<std::uint64_t>(sums[i]);
  }
  state.start();
}

bool Reduction::test() {
  State& state = *state_;
  if (!state.is_in_flight) return true;
  if (!state.has_come()) return false;
  state.finish();
  return true;
}

void Reduction::wait(double limit_seconds) {
  wait_until([this] { return test(); },
             [this] {
               return "rank " + std::to_string(state_->communicator.rank()) + ": reduction " +
                      std::to_string(state_->number) + " of all ranks" + state_->missing();
             },
             limit_seconds);
}

std::span<const double> Reduction::maxima() const {
  return state_->result_maxima;
}
std::span<const std::int64_t> Reduction::sums() const {
  return state_->result_sums;
}
bool Reduction::is_in_flight() const {
  return state_->is_in_flight;
}

}  // namespace barchan
