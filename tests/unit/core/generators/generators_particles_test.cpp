#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include <barchan/core/base/error.hpp>
#include <barchan/core/generators/make_particles.hpp>
#include <barchan/core/io/particle_file.hpp>
#include <barchan/core/io/text_file.hpp>

#include <support/temporary_folder.hpp>

namespace barchan {
namespace {

Model model_of(int dimension) {
  Model model;
  model.dimension = dimension;
  model.domain.hi = dimension == 2 ? Vec3(10, 10, 0) : Vec3(10, 10, 10);
  model.materials = {{"soil", 126.0}, {"duct", 90.0}};
  model.bond_laws.resize(2);
  return model;
}

ParticleSource lattice(LatticeSource::Arrangement arrangement, const Vec3& lo, const Vec3& hi) {
  LatticeSource kind;
  kind.arrangement = arrangement;
  kind.region = {lo, hi};
  kind.spacing = 0.5;
  kind.sizes.classes = {{0.25, 0.25, 1.0}};
  ParticleSource source;
  source.place = {"deck.toml", 7, 1};
  source.material = 0;
  source.kind = kind;
  return source;
}

ParticleSource ring(std::int64_t count) {
  ParticleSource source;
  source.material = 1;
  source.bond = 1;
  source.kind = RingSource{Vec3(5, 5, 0), 2.0, count,
                           2.0 * std::sin(std::acos(-1.0) / static_cast<double>(count)), 0.0};
  return source;
}

std::string message_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

class ParticlesFromFile : public ::testing::Test {
 protected:
  ParticleSource source(const std::string& rows) {
    OutputFile file(path_);
    file.write("id,type,radius,density,x,y,z,vx\n" + rows);
    file.commit();
    ParticleSource source;
    source.kind = FileSource{path_};
    return source;
  }

  test::TemporaryFolder folder_;
  std::string path_ = folder_.at("grains.csv");
};

using Arrangement = LatticeSource::Arrangement;

TEST(Lattice, FillsItsRegionSiteBySite) {
  EXPECT_EQ(
      make_particles(model_of(2), std::vector{lattice(Arrangement::Square, {1, 1, 0}, {3, 2, 0})})
          .particles.size(),
      8u);
  EXPECT_EQ(make_particles(model_of(2),
                           std::vector{lattice(Arrangement::Hexagonal, {1, 1, 0}, {3, 2, 0})})
                .particles.size(),
            7u);
  EXPECT_EQ(
      make_particles(model_of(3), std::vector{lattice(Arrangement::Cubic, {1, 1, 1}, {3, 2, 2})})
          .particles.size(),
      16u);
}

TEST(Lattice, HasTheNeighboursOfItsArrangement) {
  const auto most_bonds = [](Arrangement arrangement, int dimension) {
    ParticleSource source =
        lattice(arrangement, Vec3::Constant(dimension == 2 ? 0.0 : 1.0), {5, 5, 5});
    source.bond = 0;
    const ParticleSet set = make_particles(model_of(dimension), std::vector{source});
    check_particles(model_of(dimension), set);
    std::vector<int> count(set.particles.size() + 1);
    for (const BondData& bond : set.bonds) {
      ++count[static_cast<std::size_t>(bond.id_a)];
      ++count[static_cast<std::size_t>(bond.id_b)];
    }
    return *std::max_element(count.begin(), count.end());
  };
  EXPECT_EQ(most_bonds(Arrangement::Square, 2), 4);
  EXPECT_EQ(most_bonds(Arrangement::Hexagonal, 2), 6);
  EXPECT_EQ(most_bonds(Arrangement::Cubic, 3), 6);
  EXPECT_EQ(most_bonds(Arrangement::Fcc, 3), 12);
}

TEST(Lattice, JittersWithinTheGapOnly) {
  ParticleSource source = lattice(Arrangement::Square, {0, 0, 0}, {10, 10, 0});
  auto& kind = std::get<LatticeSource>(source.kind);
  kind.sizes.classes = {{0.1, 0.2, 1.0}};
  kind.jitter = 1.0;

  const ParticleSet set = make_particles(model_of(2), std::vector{source});

  EXPECT_EQ(set.particles.size(), 400u);
  check_particles(model_of(2), set);
  for (const ParticleData& p : set.particles) {
    const Vec3 off =
        p.position / 0.5 - Vec3((p.position / 0.5).array().floor()) - Vec3(0.5, 0.5, 0);
    EXPECT_LE(Vec3(off.x(), off.y(), 0).norm() * 0.5 + p.radius, 0.25 + 1e-12);
  }
}

TEST(Lattice, RefusesRegionsThatHoldNothingOrTooMuch) {
  const auto make = [](const Vec3& hi) {
    return [hi] {
      (void)make_particles(model_of(2), std::vector{lattice(Arrangement::Square, {0, 0, 0}, hi)});
    };
  };
  EXPECT_NE(message_of(make({0.4, 3, 0})).find("deck.toml:7:1"), std::string::npos);
  EXPECT_NE(message_of(make({1e9, 1e9, 0})).find("1e9"), std::string::npos);
  EXPECT_NE(message_of(make({20, 1, 0})).find("outside the domain"), std::string::npos);
}

TEST(Ring, TouchesItsNeighboursAndIsClosedByBonds) {
  const ParticleSet set = make_particles(model_of(2), std::vector{ring(40)});

  ASSERT_EQ(set.particles.size(), 40u);
  ASSERT_EQ(set.bonds.size(), 40u);
  EXPECT_EQ(set.bonds.back().id_a, 1);
  EXPECT_EQ(set.bonds.back().id_b, 40);
  EXPECT_EQ(set.bonds.back().law, 1);
  for (const BondData& bond : set.bonds) {
    const ParticleData& a = set.particles[static_cast<std::size_t>(bond.id_a - 1)];
    const ParticleData& b = set.particles[static_cast<std::size_t>(bond.id_b - 1)];
    EXPECT_NEAR((a.position - b.position).norm(), a.radius + b.radius, 1e-12);
    EXPECT_EQ(a.type, 1);
    EXPECT_EQ(a.density, 90.0);
  }
  check_particles(model_of(2), set);
}

TEST(MakeParticles, NumbersSourcesOneAfterTheOtherAndMarksFixedOnes) {
  ParticleSource second = lattice(Arrangement::Square, {0, 0, 0}, {2, 2, 0});
  second.fixed = Box{Vec3(0, 0, 0), Vec3(2, 0.5, 0)};
  second.velocity = Vec3(1, 2, 0);
  second.density = 7.0;
  ParticleSource list;
  list.kind = ListSource{{ParticleData{0, 0, 0.1, 1.0, {9, 9, 0}, Vec3::Zero(), Vec3::Zero()}}};

  const ParticleSet set = make_particles(model_of(2), std::vector{ring(30), second, list});

  ASSERT_EQ(set.particles.size(), 30u + 16u + 1u);
  for (std::size_t i = 0; i < set.particles.size(); ++i)
    EXPECT_EQ(set.particles[i].id, static_cast<std::int64_t>(i + 1));
  EXPECT_TRUE(set.particles[30].fixed);
  EXPECT_FALSE(set.particles[34].fixed);
  EXPECT_EQ(set.particles[40].velocity, Vec3(1, 2, 0));
  EXPECT_EQ(set.particles[40].density, 7.0);
}

TEST_F(ParticlesFromFile, KeepIdsTypesAndAddVelocities) {
  ParticleSource file = source("5,2,0.1,50,1,1,0,3\n3,1,0.1,50,2,2,0,0\n");
  file.velocity = Vec3(1, 0, 0);
  const ParticleSource after = lattice(Arrangement::Square, {5, 5, 0}, {6, 6, 0});

  const ParticleSet set = make_particles(model_of(2), std::vector{file, after});

  ASSERT_EQ(set.particles.size(), 2u + 4u);
  EXPECT_EQ(set.particles[0].id, 5);
  EXPECT_EQ(set.particles[0].type, 1);
  EXPECT_EQ(set.particles[0].density, 50.0);
  EXPECT_EQ(set.particles[0].velocity, Vec3(4, 0, 0));
  EXPECT_EQ(set.particles[2].id, 6);
}

TEST_F(ParticlesFromFile, NameTheLineOfWhatDoesNotFitTheDeck) {
  const auto message = [&](const std::string& rows) {
    const ParticleSource file = source(rows);
    return message_of([&] { (void)make_particles(model_of(2), std::vector{ring(30), file}); });
  };
  EXPECT_NE(message("40,1,0.1,50,1,1,0,0\n7,1,0.1,50,1,1,0,0\n")
                .find(path_ + ":3: particle id 7 is already"),
            std::string::npos);
  EXPECT_NE(message("40,1,0.1,50,1,11,0,0\n").find(path_ + ":2: particle 40 at (1, 11) is outside"),
            std::string::npos);
  EXPECT_NE(message("40,3,0.1,50,1,1,0,0\n").find("is of type 3"), std::string::npos);
  EXPECT_NE(message("40,1,0.1,50,1,1,2,0\n").find("leaves the plane"), std::string::npos);
  EXPECT_NE(message("9223372036854775807,1,0.1,50,1,1,0,0\n")
                .find(path_ + ":2: particle id 9223372036854775807 is too large (ids go up to "
                              "4611686018427387903)"),
            std::string::npos);
}

TEST_F(ParticlesFromFile, WrapOnPeriodicAxes) {
  Model model = model_of(2);
  model.domain.periodic[0] = true;

  const ParticleSet set =
      make_particles(model, std::vector{source("1,1,0.1,50,10,1,0,0\n2,1,0.1,50,-1,1,0,0\n")});

  EXPECT_EQ(set.particles[0].position.x(), 0.0);
  EXPECT_EQ(set.particles[1].position.x(), 9.0);
}

TEST(CheckParticles, NamesWhatIsWrong) {
  const ParticleSet good = make_particles(model_of(2), std::vector{ring(30)});
  const auto message = [&](const std::function<void(ParticleSet&)>& spoil) {
    ParticleSet set = good;
    spoil(set);
    return message_of([&] { check_particles(model_of(2), set); });
  };
  using Set = ParticleSet;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message([](Set&) {}), "no error");
  EXPECT_NE(message([](Set& s) { s.particles.clear(); }).find("no particles"), std::string::npos);
  EXPECT_NE(message([](Set& s) { s.particles[3].id = 9; }).find("id 9 appears twice"),
            std::string::npos);
  EXPECT_NE(message([](Set& s) { s.particles[3].id = 0; }).find("no valid id"), std::string::npos);
  EXPECT_NE(message([&](Set& s) { s.particles[3].velocity.x() = nan; }).find("particle 4"),
            std::string::npos);
  EXPECT_NE(message([](Set& s) { s.particles[3].radius = -1; }).find("radius -1"),
            std::string::npos);
  EXPECT_NE(message([](Set& s) { s.particles[3].density = 1.7e308; }).find("a mass of inf kg"),
            std::string::npos);
  EXPECT_NE(message([](Set& s) { s.particles[3].density = 0; }).find("density 0"),
            std::string::npos);
  EXPECT_NE(message([](Set& s) { s.particles[3].type = 2; }).find("type 3"), std::string::npos);
  EXPECT_NE(message([](Set& s) { s.particles[3].position.x() = -1; }).find("outside"),
            std::string::npos);
  EXPECT_NE(message([](Set& s) { s.bonds[0].id_b = 99; }).find("unknown particle"),
            std::string::npos);
  EXPECT_NE(message([](Set& s) { s.bonds[0].law = 7; }).find("unknown law"), std::string::npos);
  EXPECT_NE(message([](Set& s) { s.bonds.push_back(s.bonds[4]); }).find("bonded twice"),
            std::string::npos);
}

TEST(CheckParticles, SaysWhereAPairThatOverlapsComesFrom) {
  const Model model = model_of(2);
  ListSource list;
  ParticleData p{1, 0, 0.1, 1, {5, 5, 0}, Vec3::Zero(), Vec3::Zero()};
  list.particles = {p, p};
  list.places = {{"deck.toml", 7, 3}, {"deck.toml", 9, 3}};
  ParticleSource listed = ring(30);
  listed.kind = list;
  listed.bond.reset();
  const std::vector sources{ring(30), listed};
  std::vector<std::size_t> begins;
  const ParticleSet set = make_particles(model, sources, begins);

  const std::string message = message_of([&] {
    check_particles(model, set,
                    [&](std::size_t i) { return place_of_particle(sources, begins, i); });
  });

  EXPECT_NE(message.find("deck.toml:9:3: particle 32 at (5, 5) overlaps particle 31 at (5, 5) "
                         "(line 7) by 200 %"),
            std::string::npos)
      << message;
}

TEST(CheckParticles, RefusesGrossOverlapsUnlessBondedOrFixed) {
  const Model model = model_of(2);
  ParticleSet set =
      make_particles(model, std::vector{lattice(Arrangement::Square, {1, 1, 0}, {3, 3, 0}),
                                        lattice(Arrangement::Square, {2.1, 1.2, 0}, {5, 2, 0})});
  EXPECT_NE(message_of([&] { check_particles(model, set); }).find("% of the smaller radius"),
            std::string::npos);

  ParticleSet pair;
  pair.particles = {{1, 0, 0.1, 1, {5, 5, 0}, Vec3::Zero(), Vec3::Zero()},
                    {2, 0, 0.1, 1, {5.1, 5, 0}, Vec3::Zero(), Vec3::Zero()}};
  EXPECT_THROW(check_particles(model, pair), InputError);
  pair.bonds = {{1, 2, 0}};
  EXPECT_NO_THROW(check_particles(model, pair));
  pair.bonds.clear();
  pair.particles[0].fixed = pair.particles[1].fixed = true;
  EXPECT_NO_THROW(check_particles(model, pair));
}

TEST(CheckParticles, HoldsAnOverlapAgainstTheSmallerRadius) {
  ParticleSet pair;  // the large one would bear it
  pair.particles = {{1, 0, 1.0, 1, {5, 5, 0}, Vec3::Zero(), Vec3::Zero()},
                    {2, 0, 0.1, 1, {6.02, 5, 0}, Vec3::Zero(), Vec3::Zero()}};

  EXPECT_NE(
      message_of([&] { check_particles(model_of(2), pair); }).find("by 80 % of the smaller radius"),
      std::string::npos);
  pair.particles[1].position[0] = 6.06;
  EXPECT_NO_THROW(check_particles(model_of(2), pair));
}

TEST(CheckParticles, RefusesAVelocityOfWhatIsFixed) {
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  ParticleSource source = lattice(Arrangement::Square, {1, 1, 0}, {3, 3, 0});
  source.fixed = Box{Vec3::Constant(-kEndless), Vec3::Constant(kEndless)};
  EXPECT_NO_THROW((void)make_particles(model_of(2), std::vector{source}));
  source.velocity = Vec3(0, 1, 0);
  EXPECT_NE(message_of([&] {
              (void)make_particles(model_of(2), std::vector{source});
            }).find("particle 1 is fixed and has a velocity"),
            std::string::npos);
  source.velocity = Vec3::Zero();
  source.omega = Vec3(0, 0, 1);
  EXPECT_THROW((void)make_particles(model_of(2), std::vector{source}), InputError);

  source.fixed = Box{{1, 1, 0}, {3, 2, 0}};  // the lower half: the upper one spins
  const ParticleSet half = make_particles(model_of(2), std::vector{source});
  for (const ParticleData& p : half.particles) EXPECT_EQ(p.omega.z(), p.fixed ? 0.0 : 1.0);
  EXPECT_TRUE(half.particles.front().fixed);
  EXPECT_FALSE(half.particles.back().fixed);

  ParticleSet one;
  one.particles = {{1, 0, 0.1, 1, {5, 5, 0}, Vec3::Zero(), {0, 0, 2}, true}};
  EXPECT_THROW(check_particles(model_of(2), one), InputError);
}

}  // namespace
}  // namespace barchan
