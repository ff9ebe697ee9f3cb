#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <barchan/core/kernels/batch_scalar.hpp>
#include <barchan/core/kernels/contact_law.hpp>
#include <barchan/core/particles/fields.hpp>
#include <barchan/core/particles/share.hpp>

#include <unit/core/kernel_sample.hpp>
#include "rolling_law.hpp"

// A law of a file of its own goes wherever the program's law goes.

namespace barchan::test {
namespace {

PairKernel rolling_kernel(VectorWidth width, int dim, int variant) {
#ifdef BARCHAN_HAS_X86_KERNELS
  if (width == VectorWidth::Avx512) return pick_rolling_avx512(dim, variant);
  if (width == VectorWidth::Avx2) return pick_rolling_avx2(dim, variant);
#endif
  (void)width;
  return kernels::pick_in<RollingSpring, kernels::BatchScalar>(dim, variant);
}

LawTable rolling_laws(int num_materials, LinearSpring::Level level) {
  const ContactTable linear = table_of(num_materials);
  return {contact_law<RollingSpring>(&rolling_kernel), level, num_materials,
          [&](int a, int b, double* row) {
            ContactConstants c = a < 0 ? ContactConstants{} : linear.at(a, b);
            if (a >= 0 && level != LinearSpring::Constant) c.cn.rate = 10.0, c.ct.rate = 3.0;
            if (a >= 0 && level == LinearSpring::Critical) c.cn.critical = 20.0;
            LinearSpring::write(c, {}, row);
            row[RollingSpring::kRolling] = a < 0 ? 0.0 : 500.0 + 100.0 * (a + b);
          }};
}

template <int Dim>
constexpr int kLength = RollingSpring::kHistory<Dim>.length;

template <int Dim>
void expect_same_at_any_width(int num_materials, LinearSpring::Level level, bool is_periodic) {
  const LawTable laws = rolling_laws(num_materials, level);
  const PeriodicBox box = box_of<Dim>(is_periodic);
  Sample<Dim> sample(40, 201, laws.size(), 13, kLength<Dim>);
  for (auto& code : sample.list.code) code = std::max<std::uint8_t>(code, 1);
  std::vector<Sample<Dim>> after;
  for (const VectorWidth width : vector_widths()) {
    after.push_back(sample);
    const KernelSet kernels = make_kernels(Dim, width, laws, false, box);
    for (int n = 0; n < 3; ++n) kernels.pairs(after.back().job(laws, box));
  }
  for (std::size_t w = 1; w < after.size(); ++w) {
    const auto what =
        fmt::format("{}, {}D, {} materials, level {}, periodic {}", name_of(vector_widths()[w]),
                    Dim, num_materials, static_cast<int>(level), is_periodic);
    ASSERT_TRUE(same_bits(after[w].force, after[0].force)) << what;
    ASSERT_TRUE(same_values(after[w].list.history, after[0].list.history)) << what;
  }
}

TEST(SecondLaw, GivesTheSameBitsAtAnyWidth) {
  for (const int num_materials : {1, 2, 5}) {
    for (const auto level : {LinearSpring::Constant, LinearSpring::Rate, LinearSpring::Critical}) {
      for (const bool is_periodic : {false, true}) {
        expect_same_at_any_width<2>(num_materials, level, is_periodic);
        expect_same_at_any_width<3>(num_materials, level, is_periodic);
      }
    }
  }
}

template <int Dim>
void expect_mirrored() {
  using L = Layout<Dim>;
  const LawTable laws = rolling_laws(2, LinearSpring::Critical);
  Sample<Dim> there(40, 500, laws.size(), 23, kLength<Dim>), back = there;
  for (std::size_t k = 0; k < 500; ++k) std::swap(back.list.i[k], back.list.j[k]);
  int num_touching = 0, num_apart = 0;
  for (std::size_t k = 0; k < 500; ++k) {
    const auto one_way = forces_of_ends(there, laws, k), other_way = forces_of_ends(back, laws, k);

    ASSERT_EQ(one_way[0], other_way[1]);
    ASSERT_EQ(one_way[1], other_way[0]);
    const auto at = static_cast<std::int64_t>(k);
    for (int c = 0; c < kLength<Dim>; ++c) {
      ASSERT_EQ(there.list.history_of(at)[c * kBatch],
                RollingSpring::kHistory<Dim>.sign(c, true) * back.list.history_of(at)[c * kBatch]);
    }
    num_touching += one_way[0][0] != 0.0 ? 1 : 0;
    num_apart += one_way[0][L::kTorque] != one_way[1][L::kTorque] ? 1 : 0;
  }
  EXPECT_GT(num_touching, 20);
  EXPECT_GT(num_apart, num_touching / 2) << "the torques of the ends should differ";
}

TEST(SecondLaw, GivesEachEndWhatItGetsWhenTheEndsSwap) {
  expect_mirrored<2>();
  expect_mirrored<3>();
}

template <int Dim>
struct Box {
  Domain domain;
  World<Dim> world;
  std::vector<ParticleData> particles;

  Box() {
    domain.hi = Vec3(14.0, 3.4, Dim == 3 ? 2.3 : 0.0);
    domain.periodic = {true, false, Dim == 3};
    world = world_of<Dim>(domain, 1.1, 0.1, 200);
    world.laws = rolling_laws(2, LinearSpring::Rate);
    world.kernels = make_kernels(Dim, vector_widths().back(), world.laws, false, world.grid.box());
    particles = random_particles(Dim, domain, Dim == 2 ? 120 : 220, 0.5, 5);
  }
};

template <int Dim>
void expect_history_kept() {
  Box<Dim> box;
  const std::vector<std::vector<int>> layouts{
      {0, 3, 6, 9, 12}, {0, 5, 8, 10, 12}, {0, 2, 5, 8, 12}};
  Lanes<Dim> many(box.world, layouts[0]), one(box.world, {0, 12});
  many.seed(box.particles);
  one.seed(box.particles);
  for (std::size_t round = 1; round < layouts.size(); ++round) {
    for (int n = 0; n < 3; ++n) many.step(), one.step();
    bool before_agrees = false, after_agrees = false, alone_agrees = false;
    const Springs before = many.springs(before_agrees);

    many.rebuild(layouts[round]);
    const Springs after = many.springs(after_agrees);

    EXPECT_GT(before.size(), 100U);
    EXPECT_EQ(before.begin()->second.size(), std::size_t{kLength<Dim>});
    EXPECT_TRUE(before_agrees);
    EXPECT_TRUE(after_agrees);
    EXPECT_EQ(after, before) << "round " << round;
    EXPECT_EQ(one.springs(alone_agrees), before) << "round " << round;
    EXPECT_EQ(many.digest(), one.digest()) << "round " << round;
  }
}

TEST(SecondLaw, KeepsItsHistoryThroughListsMessagesAndRebuilds) {
  expect_history_kept<2>();
  expect_history_kept<3>();
}

/// With the particles of these slabs, and all links.
template <int Dim>
CheckpointShare part_of(const CheckpointShare& all, const Grid<Dim>& grid, int begin, int end) {
  CheckpointShare part = all;
  for_each_field<Dim>([&](const auto& field) {
    const auto& from = all.*field.saved;
    auto& to = part.*field.saved;
    const auto width = static_cast<std::size_t>(field.width);
    to.clear();
    for (std::size_t p = 0; p < all.ids.size() && !from.empty(); ++p) {
      const int slab = grid.coordinate(all.positions.data() + p * Dim, 0);
      if (slab < begin || slab >= end) continue;
      for (std::size_t c = 0; c < width; ++c) to.push_back(from[p * width + c]);
    }
  });
  return part;
}

template <int Dim>
void expect_history_saved() {
  Box<Dim> box;
  const std::vector<int> cuts{0, 4, 8, 12};
  Lanes<Dim> one(box.world, {0, 12}), many(box.world, cuts);
  one.seed(box.particles);
  for (int n = 0; n < 3; ++n) one.step();
  CheckpointShare share;
  barchan::save(one[0].brick, share);

  std::vector<CheckpointShare> parts;
  for (std::size_t l = 0; l + 1 < cuts.size(); ++l)
    parts.push_back(part_of(share, box.world.grid, cuts[l], cuts[l + 1]));
  many.restore(parts);

  bool one_agrees = false, many_agrees = false;
  EXPECT_EQ(many.springs(many_agrees), one.springs(one_agrees));
  EXPECT_TRUE(many_agrees);
  EXPECT_EQ(share.contact_springs.size(),
            share.contact_ids.size() / 2 * static_cast<std::size_t>(kLength<Dim>));
}

TEST(SecondLaw, KeepsItsHistoryInACheckpoint) {
  expect_history_saved<2>();
  expect_history_saved<3>();
}

TEST(SecondLaw, StoresItsOwnEnergy) {
  Box<2> box;
  Lanes<2> lanes(box.world, {0, 12});
  lanes.seed(box.particles);
  for (int n = 0; n < 3; ++n) lanes.step();
  const double mine = barchan::measure(lanes[0].brick, Vec3::Zero()).elastic.value();
  box.world.laws = LawTable(table_of(2));

  const double linear = barchan::measure(lanes[0].brick, Vec3::Zero()).elastic.value();

  EXPECT_GT(mine, linear);
}

}  // namespace
}  // namespace barchan::test
