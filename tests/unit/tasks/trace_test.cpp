#include <barchan/tasks/trace.hpp>

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <support/mpi_session.hpp>
#include <support/temporary_folder.hpp>

namespace barchan {
namespace {

class TraceFile : public testing::Test {
 protected:
  TraceFile() : communicator_(test::world()) {}

  nlohmann::json written(const Trace& trace) {
    trace.write(path_);
    return nlohmann::json::parse(std::ifstream(path_)).at("traceEvents");
  }

  Communicator communicator_;
  test::TemporaryFolder folder_;
  std::string path_ = folder_.at("trace.json");
};

TEST_F(TraceFile, HoldsSlicesWithNameStepAndDuration) {
  Trace trace(communicator_, {}, 1, 16);
  trace.begin_step(7);
  const std::int64_t begin = now_ns();
  trace.slice(Trace::Slice::Chunk, 2, begin, begin + 5000);

  const auto events = written(trace);

  const auto& slice = events.back();
  EXPECT_EQ(slice.at("ph"), "X");
  EXPECT_EQ(slice.at("name"), "chunk");
  EXPECT_EQ(slice.at("args").at("step"), 7);
  EXPECT_EQ(slice.at("args").at("lane"), 2);
  EXPECT_NEAR(slice.at("dur").get<double>(), 5.0, 1e-6);
  EXPECT_GE(slice.at("ts").get<double>(), 0.0);
}

TEST_F(TraceFile, GivesBothEndsOfAMessageTheSameName) {
  // Both neighbours are rank 0 itself.
  Trace trace(communicator_, {{{0, kRightLink}, {0, kLeftLink}}}, 1, 16);
  trace.sent(kRightLink, 4, now_ns());
  trace.noticed(kLeftLink, 4, now_ns());

  const auto events = written(trace);

  std::set<std::string> ids, kinds;
  for (const auto& event : events) {
    if (event.value("cat", "") != "halo") continue;
    ids.insert(event.at("id"));
    kinds.insert(event.at("ph"));
  }
  EXPECT_EQ(ids.size(), 1U);
  EXPECT_EQ(kinds, (std::set<std::string>{"s", "f"}));
}

TEST_F(TraceFile, KeepsTheLatestEventsOfAFullRing) {
  Trace trace(communicator_, {}, 1, 4);
  for (std::int64_t step = 0; step < 10; ++step) {
    trace.begin_step(step);
    trace.slice(Trace::Slice::Wait, 0, now_ns(), now_ns());
  }

  EXPECT_EQ(trace.num_events(), 4U);
  EXPECT_EQ(trace.num_lost(), 6U);
  EXPECT_EQ(written(trace).back().at("args").at("step"), 9);
}

}  // namespace
}  // namespace barchan
