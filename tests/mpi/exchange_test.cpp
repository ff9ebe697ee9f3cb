// Values encode rank, link, step and index, so that a message that lands in the wrong place or step
// shows.

#include <barchan/comm/exchanges/make_exchange.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <barchan/comm/base/watchdog.hpp>
#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

constexpr std::array both_links{kLeftLink, kRightLink};

int opposite(int link) {
  return link == kLeftLink ? kRightLink : kLeftLink;
}

std::size_t length_of(int rank, int link, int step, std::size_t at_most) {
  std::mt19937_64 random(static_cast<std::uint64_t>(rank * 2 + link) * 1000003U +
                         static_cast<std::uint64_t>(step));
  if (random() % 8 == 0) return 0;
  if (random() % 8 == 0) return at_most;
  return random() % (at_most + 1);
}

std::byte value_of(int rank, int link, int step, std::size_t index) {
  const auto word = static_cast<std::uint64_t>(rank + 1) * 0x9E3779B97F4A7C15U ^
                    static_cast<std::uint64_t>(link + 1) * 0xC2B2AE3D27D4EB4FU ^
                    static_cast<std::uint64_t>(step) * 0x165667B19E3779F9U ^
                    index * 0x27D4EB2F165667C5U;
  return static_cast<std::byte>(word >> 40 & 0xFF);
}

void fill(std::span<std::byte> bytes, int rank, int link, int step) {
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = value_of(rank, link, step, i);
}

std::vector<std::byte> message_of(int rank, int link, int step, std::size_t length) {
  std::vector<std::byte> bytes(length);
  fill(bytes, rank, link, step);
  return bytes;
}

struct Case {
  std::string exchange;
  bool is_periodic = false;
  int ranks_per_node = 0;
};

class ExchangeOfEveryKind : public testing::TestWithParam<Case> {
 protected:
  ExchangeOfEveryKind()
      : neighbours_(strip_neighbours(comm_.rank(), comm_.size(), GetParam().is_periodic)) {}

  std::unique_ptr<Exchange> make(ExchangeOptions options = {}) {
    options.hooks.ranks_per_node = GetParam().ranks_per_node;
    return make_exchange(GetParam().exchange, comm_, neighbours_, options);
  }

  void send(Exchange& exchange, int link, int step, std::size_t at_most) {
    if (!neighbours_.has(link)) return;
    const std::size_t length = length_of(comm_.rank(), link, step, at_most);
    fill(exchange.outgoing(link, length), comm_.rank(), link, step);
    exchange.send(link);
  }

  void receive(Exchange& exchange, int link, int step, std::size_t at_most) {
    if (!neighbours_.has(link)) return;
    wait_until([&] { return exchange.poll(link); }, [&] { return "step " + std::to_string(step); });
    const int from = neighbours_.rank(link);
    const auto expected =
        message_of(from, opposite(link), step, length_of(from, opposite(link), step, at_most));
    const auto received = exchange.received(link);
    ASSERT_EQ(received.size(), expected.size()) << "step " << step << " " << link;
    ASSERT_TRUE(std::ranges::equal(received, expected)) << "step " << step << " " << link;
    exchange.release(link);
  }

  void run_steps(Exchange& exchange, int begin, int end, std::size_t at_most) {
    for (int step = begin; step < end; ++step) {
      for (const int link : both_links) send(exchange, link, step, at_most);
      const bool is_left_first = step % 3 != 0;
      receive(exchange, is_left_first ? kLeftLink : kRightLink, step, at_most);
      receive(exchange, is_left_first ? kRightLink : kLeftLink, step, at_most);
      if (HasFatalFailure()) comm_.abort(1);
    }
  }

  std::vector<std::byte> bulk_of(int rank, int link, int step, std::size_t at_most) {
    return message_of(rank, link, step, length_of(rank, link, step, at_most));
  }

  void run_bulk(Exchange& exchange, int step, std::size_t at_most) {
    const auto mine = [&](int link) {
      return neighbours_.has(link) ? bulk_of(comm_.rank(), link, step, at_most)
                                   : std::vector<std::byte>{};
    };
    const std::vector<std::byte> left = mine(kLeftLink), right = mine(kRightLink);
    const std::array<std::span<const std::byte>, 2> outgoing{left, right};
    exchange.begin_bulk(outgoing);
    wait_until([&] { return exchange.poll_bulk(); },
               [&] { return "bulk " + std::to_string(step); });
    for (const int link : both_links) {
      const int from = neighbours_.rank(link);
      const auto expected =
          from < 0 ? std::vector<std::byte>{} : bulk_of(from, opposite(link), step, at_most);
      EXPECT_TRUE(exchange.bulk(link) == expected) << "bulk " << step << " " << link;
    }
    if (HasFailure()) comm_.abort(1);
  }

  Communicator comm_ = Communicator::world();
  Neighbours neighbours_;
};

TEST_P(ExchangeOfEveryKind, BringsEveryHaloToTheRightPlaceInTheRightStep) {
  const auto exchange = make({.halo_bytes = 10000, .hooks = {}});

  run_steps(*exchange, 0, 400, 10000);

  const ExchangeStats stats = exchange->stats();
  const auto num_links =
      static_cast<std::uint64_t>(neighbours_.has(kLeftLink) + neighbours_.has(kRightLink));
  EXPECT_EQ(stats.halo_messages, 400 * num_links);
  EXPECT_FALSE(stats.transport.empty());
  EXPECT_EQ(exchange->name(), GetParam().exchange);
}

/// Each rank is as many messages ahead of those that it has as the depth lets it, and ranks have
/// different ones at a time; also after slots have grown.
TEST_P(ExchangeOfEveryKind, LetsSoManyMessagesBeUnderWayAsTheDepthSays) {
  constexpr int kDepth = 3, kSteps = 40;
  ExchangeOptions options;
  options.depth = kDepth;
  options.halo_bytes = 500;
  const auto exchange = make(options);
  for (const std::size_t bytes : {500U, 1500U}) {
    exchange->reserve(bytes);
    const int first = bytes == 500 ? 0 : kSteps;
    for (int step = 0; step < kSteps + kDepth; ++step) {
      for (const int link : both_links) {
        if (step < kSteps) send(*exchange, link, first + step, bytes);
        if (step >= kDepth) receive(*exchange, link, first + step - kDepth, bytes);
      }
      if (HasFatalFailure()) comm_.abort(1);
    }
  }
}

TEST_P(ExchangeOfEveryKind, GrowsInMidRunAndLosesNothing) {
  const auto exchange = make({64, 64, {}});
  std::size_t room = 64;

  for (int growth = 0; growth < 6; ++growth) {
    exchange->reserve(room);
    run_steps(*exchange, 100 * growth, 100 * growth + 20, room);
    run_bulk(*exchange, growth, 3 * room);
    room = room * 7 + 13;
  }

  EXPECT_GE(exchange->stats().growths, 4U);
  EXPECT_EQ(exchange->stats().bulk_capacity > 64U, comm_.size() > 1);
}

TEST_P(ExchangeOfEveryKind, ReservingNoMoreThanThereIsChangesNothing) {
  const auto exchange = make({.halo_bytes = 1000, .hooks = {}});

  exchange->reserve(500);
  exchange->reserve(1000);

  EXPECT_EQ(exchange->stats().growths, 0U);
}

TEST_P(ExchangeOfEveryKind, MovesBulksOfAnyLengthThroughSmallSlots) {
  const auto exchange = make({256, 1000, {}});

  for (int step = 0; step < 60; ++step) {
    run_bulk(*exchange, step, step % 10 == 0 ? 0 : 5000);
    run_steps(*exchange, 4 * step, 4 * step + 4, 256);
  }

  EXPECT_TRUE(exchange->poll_bulk());
}

TEST_P(ExchangeOfEveryKind, MovesBulksOfMegabytes) {
  const auto exchange = make({256, 100000, {}});

  for (int step = 0; step < 4; ++step) run_bulk(*exchange, step, 3000000);

  EXPECT_TRUE(exchange->poll_bulk());
}

TEST_P(ExchangeOfEveryKind, KeepsTheBytesBehindRandomDelays) {
  const auto exchange = make({.halo_bytes = 3000,
                              .bulk_bytes = 500,
                              .hooks = {.max_delay_seconds = 4e-4, .delay_seed = 7}});

  for (int round = 0; round < 15; ++round) {
    run_steps(*exchange, 10 * round, 10 * round + 10, 3000);
    run_bulk(*exchange, round, 2000);
  }

  EXPECT_TRUE(exchange->poll_bulk());
}

// The `return` scheme: a band goes right, and only the neighbour's answer to it goes left.
TEST_P(ExchangeOfEveryKind, AnswersWithinTheStepWhereSidesMayBeUneven) {
  const auto exchange = make({.halo_bytes = 2000, .hooks = {}});
  const bool is_even = std::string(GetParam().exchange) == "fence";
  EXPECT_EQ(exchange->allows_uneven_sides(), !is_even);
  if (is_even) return;

  for (int step = 0; step < 200; ++step) {
    send(*exchange, kRightLink, step, 2000);
    receive(*exchange, kLeftLink, step, 2000);
    send(*exchange, kLeftLink, step, 2000);
    receive(*exchange, kRightLink, step, 2000);
    if (HasFatalFailure()) comm_.abort(1);
  }

  const auto num_links =
      static_cast<std::uint64_t>(neighbours_.has(kLeftLink) + neighbours_.has(kRightLink));
  EXPECT_EQ(exchange->stats().messages(), 200 * num_links);
}

TEST_P(ExchangeOfEveryKind, RefusesToPackAheadOfTheNeighbour) {
  const auto exchange = make();
  if (comm_.size() > 1) {
    for (const int link : both_links) send(*exchange, link, 0, 100);
    const int link = neighbours_.has(kLeftLink) ? kLeftLink : kRightLink;

    EXPECT_THROW(static_cast<void>(exchange->outgoing(link, 8)), std::logic_error);

    receive(*exchange, kLeftLink, 0, 100);
    receive(*exchange, kRightLink, 0, 100);
    EXPECT_THROW(static_cast<void>(exchange->outgoing(link, std::size_t{1} << 20)),
                 std::logic_error);
  }
  if (!neighbours_.has(kLeftLink)) {
    EXPECT_THROW(static_cast<void>(exchange->outgoing(kLeftLink, 8)), std::logic_error);
    EXPECT_FALSE(exchange->poll(kLeftLink));
  }
  comm_.barrier();
}

void PrintTo(const Case& each, std::ostream* out) {
  *out << each.exchange << (each.is_periodic ? ", periodic" : ", open");
}

std::vector<Case> every_case() {
  std::vector<Case> cases;
  for (const std::string& name : exchange_names()) {
    cases.push_back({name, false});
    cases.push_back({name, true});
  }
  for (const char* mix :
       {"shared+put-inband", "put-flag+isend", "shared+sendrecv", "isend+pscw", "get+get"}) {
    cases.push_back({mix, true, 2});
  }
  cases.push_back({"shared+put-inband", false, 2});
  cases.push_back({"shared+isend", false, 1});  // no two ranks on one node
  cases.push_back({"shared+isend", true, 4});   // all on one
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Comm, ExchangeOfEveryKind, testing::ValuesIn(every_case()),
                         [](const auto& instance) {
                           std::string name = instance.param.exchange;
                           std::ranges::replace(name, '-', '_');
                           std::ranges::replace(name, '+', '_');
                           const int on_node = instance.param.ranks_per_node;
                           if (on_node > 0) name += "_" + std::to_string(on_node) + "_a_node";
                           return name + (instance.param.is_periodic ? "_periodic" : "_open");
                         });

TEST(Exchange, TellsTheKnownNamesWhenAskedForAnUnknownOne) {
  const auto comm = Communicator::world();

  try {
    static_cast<void>(make_exchange("put-flg", comm, Neighbours{}));
    FAIL() << "an unknown exchange was made";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("put-flag"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("sendrecv"), std::string::npos) << error.what();
  }
}

TEST(Exchange, MixesUseEachKindWhereItsNeighboursAre) {
  const auto comm = Communicator::world();
  const auto neighbours = strip_neighbours(comm.rank(), comm.size(), false);
  ExchangeOptions options;
  options.hooks.ranks_per_node = 2;

  const auto exchange = make_exchange("shared+isend", comm, neighbours, options);

  const std::array<const char*, 3> expected{"two-sided", "shared memory",
                                            "shared memory and two-sided"};
  EXPECT_EQ(exchange->stats().transport, expected[std::min<std::size_t>(comm.size() - 1, 2)]);
}

TEST(Exchange, RefusesAFenceInAMixAndMessagesThatDoNotFitIntoMemory) {
  const auto comm = Communicator::world();
  const auto neighbours = strip_neighbours(comm.rank(), comm.size(), false);
  ExchangeOptions options;

  EXPECT_THROW(static_cast<void>(make_exchange("fence+isend", comm, neighbours, options)),
               InputError);
  EXPECT_THROW(static_cast<void>(make_exchange("shared+put-flg", comm, neighbours, options)),
               InputError);
  options.halo_bytes = std::size_t{1} << 45;
  EXPECT_THROW(static_cast<void>(make_exchange("put-flag", comm, neighbours, options)), InputError);
}

TEST(Exchange, PutFlagIsTheFirstName) {
  EXPECT_EQ(exchange_names().front(), "put-flag");
}

}  // namespace
}  // namespace barchan
