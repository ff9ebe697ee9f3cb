#include <barchan/comm/probe/probe.hpp>

#include <gtest/gtest.h>

#include <algorithm>

#include <barchan/comm/exchanges/make_exchange.hpp>
#include <barchan/comm/probe/auto_exchange.hpp>
#include <barchan/comm/slots/plain_put.hpp>
#include <barchan/comm/topology/clock_offset.hpp>
#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

class Probe : public testing::Test {
 protected:
  Communicator comm_ = Communicator::world();
  Neighbours neighbours_ = strip_neighbours(comm_.rank(), comm_.size(), false);
};

TEST_F(Probe, MeasuresEveryExchangeAndSize) {
  ProbeOptions options;
  options.sizes = {64, 20000};
  options.budget_seconds = 0.002;
  if (comm_.size() == 1) {
    EXPECT_THROW((void)probe_exchanges(comm_, options), InputError);
    return;
  }

  const ProbeReport report = probe_exchanges(comm_, options);

  EXPECT_EQ(report.num_links, comm_.size() - 1);
  EXPECT_EQ(report.rows.size() + options.sizes.size() * report.obstacles.size(),
            options.sizes.size() * exchange_names().size());
  for (const ProbeRow& row : report.rows) {
    EXPECT_GT(row.cost.half_round_trip, 0.0) << row.exchange;
    EXPECT_GT(row.cost.both_ways, 0.0) << row.exchange;
    EXPECT_GT(row.cost.cpu, 0.0) << row.exchange;
    EXPECT_GE(row.cost.overlap, 0.0) << row.exchange;
    EXPECT_LE(row.cost.overlap, 1.0) << row.exchange;
  }
}

TEST_F(Probe, MeasuresMixesWhereLinksAreOfBothKinds) {
  ProbeOptions options;
  options.sizes = {64};
  options.budget_seconds = 0.001;
  options.hooks.ranks_per_node = 2;
  if (comm_.size() < 3) return;  // one link

  const ProbeReport report = probe_exchanges(comm_, options);

  std::vector<std::string> found;
  for (const ProbeRow& row : report.rows) found.push_back(row.exchange);
  for (const ExchangeObstacle& o : report.obstacles) found.push_back(o.exchange);
  for (const std::string name : {"shared", "isend", "shared+put-inband", "shared+isend"}) {
    EXPECT_EQ(std::ranges::count(found, name), 1) << name;
  }
  EXPECT_EQ(report.num_on_node, comm_.size() / 2);
}

TEST_F(Probe, ReportsTheSameFiguresOnEveryRank) {
  ProbeOptions options;
  options.exchanges = {"isend"};
  options.sizes = {256};
  options.budget_seconds = 0.001;
  if (comm_.size() == 1) {
    EXPECT_THROW((void)probe_exchanges(comm_, options), InputError);
    return;
  }

  const double mine = probe_exchanges(comm_, options).rows.at(0).cost.half_round_trip;

  double most = mine, least = mine;
  comm_.allreduce_max(std::span(&most, 1));
  comm_.allreduce_min(std::span(&least, 1));
  EXPECT_EQ(most, least);
}

TEST_F(Probe, KnowsThatAllRanksOfThisTestShareANode) {
  const Links links = count_links(comm_, neighbours_);

  EXPECT_EQ(links.all, comm_.size() - 1);
  EXPECT_EQ(links.on_node, comm_.size() == comm_.node_size() ? links.all : links.on_node);
  EXPECT_EQ(clock_offset_ns(comm_), 0);
}

TEST_F(Probe, ChoosesOneExchangeOnAllRanksAndMovesMessagesWithIt) {
  const SelectedExchange selected = select_exchange(comm_, neighbours_, {}, 1000, {50e-6, 2});

  const auto names = auto_candidates(count_links(comm_, neighbours_));
  const auto place = std::ranges::find(names, selected.choice.name) - names.begin();
  double most = static_cast<double>(place), least = most;
  comm_.allreduce_max(std::span(&most, 1));
  comm_.allreduce_min(std::span(&least, 1));
  EXPECT_EQ(most, least);
  EXPECT_LT(static_cast<std::size_t>(place), names.size());
  EXPECT_EQ(selected.exchange->name(), selected.choice.name);
  EXPECT_EQ(selected.choice.candidates.size(), names.size());
  EXPECT_NE(selected.choice.reason.find(selected.choice.name), std::string::npos);
  ExchangeProbe probe(comm_, neighbours_, *selected.exchange, 5000, 1e-3);
  EXPECT_EQ(probe.half_round_trip() > 0.0, comm_.size() > 1);  // alone there is nobody to answer
}

}  // namespace
}  // namespace barchan
