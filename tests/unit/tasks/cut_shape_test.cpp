#include <barchan/tasks/cut_shape.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

CutRoom room(std::array<int, 3> cells, std::int64_t num_particles) {
  CutRoom r;
  r.cells = cells;
  r.dimension = cells[2] > 1 ? 3 : 2;
  r.num_particles = num_particles;
  return r;
}

CutRequest request(const std::string& cuts, int ranks, int threads = 1) {
  return {parse_cuts(cuts), ranks, threads, false, {}};
}

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& e) {
    return e.what();
  }
  return "not refused";
}

TEST(CutShape, KeepsStripsWhereTheyAreThickOrParticlesFew) {
  for (const auto& r : {room({120, 12, 1}, 5000), room({200, 30, 1}, 10000),
                        room({400, 20, 20}, 1000000), room({40, 40, 40}, 100000)}) {
    for (const int ranks : {1, 2, 5})
      EXPECT_EQ(choose_cuts(request("auto", ranks), r).form, CutForm::Strips) << ranks;
  }
}

TEST(CutShape, TakesBricksForACubeOfManyRanks) {
  const CutRoom cube = room({100, 100, 100}, 3000000);

  const CutShape shape = choose_cuts(request("auto", 64), cube);

  EXPECT_EQ(shape.form, CutForm::Bricks);
  EXPECT_EQ(shape.ranks, (std::array{4, 4, 4}));
}

TEST(CutShape, FindsRoomForManyMoreLanesThanStripsDo) {
  const CutRoom cube = room({36, 36, 36}, 100000);
  ASSERT_EQ(cube.most_strips(), 18);

  const CutShape alone = choose_cuts(request("auto", 1, 64), cube),
                 many = choose_cuts(request("auto", 512, 8), cube);

  EXPECT_EQ(alone.num_lanes(), 64);
  EXPECT_EQ(many.num_ranks() * many.num_lanes(), 4096);
}

TEST(CutShape, CutsAsTheAxesOfTheDeckAreNamed) {
  CutRoom r = room({40, 30, 20}, 100000);
  r.axes = {2, 0, 1};  // the grid's first axis is z

  const CutShape shape = choose_cuts(request("1,2,3", 6), r);

  EXPECT_EQ(shape.ranks, (std::array{3, 1, 2}));
  EXPECT_EQ(describe(shape, r), "1 x 2 x 3");
}

TEST(CutShape, TakesBricksAlongTheStripAxisAloneForStrips) {
  const CutRoom r = room({40, 30, 20}, 100000);

  EXPECT_EQ(choose_cuts(request("4,1,1", 4), r).form, CutForm::Strips);
  EXPECT_EQ(choose_cuts(request("30,1,1", 30), r).form, CutForm::Bricks);  // a cell or two thick
}

TEST(CutShape, SaysWhatWouldFit) {
  const CutRoom r = room({12, 8, 6}, 1000);

  const std::string product = refusal([&] { (void)choose_cuts(request("2,2,2", 6), r); });
  EXPECT_NE(product.find("cuts = [2, 2, 2] make 8 bricks for 6 ranks"), std::string::npos)
      << product;
  EXPECT_NE(product.find("for 6 ranks cuts = ["), std::string::npos) << product;

  const std::string cells = refusal([&] { (void)choose_cuts(request("1,1,8", 8), r); });
  EXPECT_NE(cells.find("8 bricks along z, where the domain has 6 cells"), std::string::npos)
      << cells;

  const std::string strips = refusal([&] { (void)choose_cuts(request("strips", 7), r); });
  EXPECT_NE(strips.find("7 ranks as strips of 2 cells, of which 6 fit"), std::string::npos)
      << strips;

  const std::string most = refusal([&] { (void)choose_cuts(request("auto", 1009), r); });
  EXPECT_NE(most.find("1009 ranks for a domain of 12 x 8 x 6 cells"), std::string::npos) << most;
}

TEST(CutShape, RefusesToReturnForcesOverBricks) {
  CutRequest returns = request("2,2,1", 4);
  returns.needs_strips = true;
  const CutRoom r = room({12, 8, 6}, 1000);

  const std::string text = refusal([&] { (void)choose_cuts(returns, r); });
  returns.wish = {};

  EXPECT_NE(text.find("exchange 'return' works on strips"), std::string::npos) << text;
  EXPECT_EQ(choose_cuts(returns, r).form, CutForm::Strips);
}

TEST(CutShape, ReadsCutsFromTheCommandLine) {
  EXPECT_EQ(parse_cuts("auto").kind, CutWish::Kind::Auto);
  EXPECT_EQ(parse_cuts("strips").kind, CutWish::Kind::Strips);
  EXPECT_EQ(parse_cuts("2,3").bricks, (std::array{2, 3, 1}));
  EXPECT_EQ(parse_cuts("2x3x4").bricks, (std::array{2, 3, 4}));
  for (const char* wrong : {"", "2", "stripes", "2,", "2,0", "2,-1", "1,2,3,4", "2;2"})
    EXPECT_THROW((void)parse_cuts(wrong), InputError) << wrong;
}

}  // namespace
}  // namespace barchan
