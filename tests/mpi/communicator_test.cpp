#include <barchan/comm/base/communicator.hpp>

#include <array>
#include <string>

#include <gtest/gtest.h>

#include <barchan/comm/base/mpi_error.hpp>
#include <barchan/comm/base/mpi_session.hpp>
#include <barchan/comm/base/watchdog.hpp>

namespace barchan {
namespace {

TEST(Communicator, DuplicatesTheCallers) {
  int rank = -1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);

  const auto comm = Communicator::world();

  EXPECT_NE(comm.handle(), MPI_COMM_WORLD);
  EXPECT_EQ(comm.rank(), rank);
  EXPECT_EQ(comm.node_size(), comm.size());  // the tests run on one node
  EXPECT_EQ(comm.node_rank(), rank);
}

TEST(Communicator, ReducesInPlace) {
  const auto comm = Communicator::world();
  const std::int64_t num = comm.size();
  std::array<std::int64_t, 2> sums{comm.rank() + 1, -1};
  std::array<std::uint64_t, 1> wrapping{~std::uint64_t{0}};
  std::array maxima{static_cast<double>(comm.rank()), -static_cast<double>(comm.rank())};
  std::array minima{static_cast<double>(comm.rank())};

  comm.allreduce_sum(std::span<std::int64_t>(sums));
  comm.allreduce_sum(std::span<std::uint64_t>(wrapping));
  comm.allreduce_max(std::span<double>(maxima));
  comm.allreduce_min(std::span<double>(minima));

  EXPECT_EQ(sums[0], num * (num + 1) / 2);
  EXPECT_EQ(sums[1], -num);
  EXPECT_EQ(wrapping[0], static_cast<std::uint64_t>(-num));
  EXPECT_EQ(maxima[0], static_cast<double>(num - 1));
  EXPECT_EQ(maxima[1], 0.0);
  EXPECT_EQ(minima[0], 0.0);
}

TEST(Communicator, AgreesOnFlags) {
  const auto comm = Communicator::world();

  EXPECT_TRUE(comm.any_of(comm.is_root()));
  EXPECT_FALSE(comm.any_of(false));
  EXPECT_TRUE(comm.all_of(true));
  EXPECT_EQ(comm.all_of(comm.is_root()), comm.size() == 1);
}

TEST(Communicator, GathersStringsOfAnyLengthInRankOrder) {
  const auto comm = Communicator::world();
  const auto text_of = [](int rank) {
    return std::string(static_cast<std::size_t>(rank * 100000), static_cast<char>('a' + rank % 26));
  };

  const auto texts = comm.gather(text_of(comm.rank()));

  if (!comm.is_root()) {
    EXPECT_TRUE(texts.empty());
    return;
  }
  ASSERT_EQ(texts.size(), static_cast<std::size_t>(comm.size()));
  for (int rank = 0; rank < comm.size(); ++rank)
    EXPECT_EQ(texts[static_cast<std::size_t>(rank)], text_of(rank));
}

TEST(Communicator, BroadcastsTextOfTheRoot) {
  const auto comm = Communicator::world();

  EXPECT_EQ(comm.bcast(comm.is_root() ? std::string("a deck") : std::string(), 0), "a deck");
  EXPECT_EQ(comm.bcast(std::string(), comm.size() - 1), "");
}

TEST(Communicator, GivesEveryRankTheSameFirstError) {
  const auto comm = Communicator::world();
  const std::string mine = comm.rank() == comm.size() - 1 ? "the last rank's disk is full" : "";

  EXPECT_EQ(comm.first_error(mine), "the last rank's disk is full");
  EXPECT_EQ(comm.first_error(""), "");
}

TEST(Communicator, GivesItsHandleAwayWhenMoved) {
  auto comm = Communicator::world();
  const MPI_Comm handle = comm.handle();

  const Communicator moved = std::move(comm);

  EXPECT_EQ(moved.handle(), handle);
  moved.barrier();
}

TEST(MpiError, NamesCallRankAndReason) {
  const auto comm = Communicator::world();
  try {
    int value = 0;
    check(MPI_Send(&value, 1, MPI_INT, comm.size(), 0, comm.handle()), "MPI_Send");  // no such rank
    FAIL() << "an error code went unseen";
  } catch (const MpiError& error) {
    EXPECT_EQ(error.call(), "MPI_Send");
    EXPECT_EQ(error.rank(), comm.rank());
    EXPECT_NE(error.code(), MPI_SUCCESS);
    EXPECT_NE(std::string(error.what()).find("MPI_Send failed on rank"), std::string::npos)
        << error.what();
  }
}

TEST(MpiSession, TellsTheLibraryAndItsThreadLevel) {
  EXPECT_FALSE(mpi_library_version().empty());
  EXPECT_TRUE(mpi_thread_level() == "serialized" || mpi_thread_level() == "multiple");
  EXPECT_TRUE(is_mpi_initialized());
}

TEST(Communicator, DoesNotWaitForEverForARankThatNeverComes) {
  const auto comm = Communicator::world();
  const double before = wait_limit();
  set_wait_limit(0.2);
  const bool is_late = comm.rank() == comm.size() - 1;

  std::string said;
  try {
    if (!is_late) comm.barrier();
  } catch (const WaitError& error) {
    said = error.what();
  }
  set_wait_limit(before);
  MPI_Barrier(MPI_COMM_WORLD);
  if (is_late) comm.barrier();

  const std::string mine = "rank " + std::to_string(comm.rank()) + ": all ranks";
  EXPECT_EQ(said.find(mine) != std::string::npos, !is_late) << said;
}

}  // namespace
}  // namespace barchan
