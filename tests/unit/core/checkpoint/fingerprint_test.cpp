// What a restart holds against its deck: every number that the state depends on.
#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <vector>

#include <barchan/core/checkpoint/state.hpp>

namespace barchan {
namespace {

enum Part { Space, Step, Gravity, Densities, Contacts, Bonds, Walls, Stages, Heat, kNumParts };

Model some_model() {
  Model m;
  m.domain.hi = Vec3(8.0, 4.0, 2.0);
  m.time.step = 1e-4;
  m.materials.resize(1);
  m.contacts = {1, {ContactConstants{}}, true};
  m.bond_laws.resize(1);
  m.walls.resize(1);
  m.stages.resize(2);
  return m;
}

using Change = std::function<void(Model&)>;

void expect_seen(Part part, const std::vector<Change>& changes) {
  const auto before = fingerprint(some_model());
  ASSERT_EQ(before.size(), std::size_t{kNumParts});
  for (std::size_t n = 0; n < changes.size(); ++n) {
    Model model = some_model();
    changes[n](model);
    const auto after = fingerprint(model);
    for (std::size_t p = 0; p < before.size(); ++p)
      EXPECT_EQ(after[p] != before[p], p == part) << "part " << p << ", change " << n;
  }
}

TEST(Fingerprint, SeesWhereAndWhenARunIs) {
  expect_seen(
      Space, {[](Model& m) { m.dimension = 3; }, [](Model& m) { m.domain.lo[1] = -1.0; },
              [](Model& m) { m.domain.hi[2] = 3.0; }, [](Model& m) { m.domain.periodic[0] = true; },
              [](Model& m) { m.domain.strip_axis = 1; }});
  expect_seen(Step, {[](Model& m) { m.time.step *= 1.0 + 1e-15; }});
  expect_seen(Gravity, {[](Model& m) { m.gravity[0] = 1e-9; }, [](Model& m) { m.gravity[2] = 1; }});
}

TEST(Fingerprint, SeesEveryConstantOfContacts) {
  using C = ContactConstants;
  const auto with = [](const std::function<void(C&)>& change) {
    return [change](Model& m) { change(m.contacts.constants[0]); };
  };
  expect_seen(Densities, {[](Model& m) { m.materials[0].density = 2.0; }});
  expect_seen(Contacts,
              {[](Model& m) { m.contacts.no_tension = false; }, with([](C& c) { c.kn = 1.0; }),
               with([](C& c) { c.kt = 1.0; }), with([](C& c) { c.mu = 1.0; }),
               with([](C& c) { c.cn.constant = 1.0; }), with([](C& c) { c.cn.rate = 1.0; }),
               with([](C& c) { c.cn.critical = 1.0; }), with([](C& c) { c.ct.constant = 1.0; }),
               with([](C& c) { c.ct.rate = 1.0; }), with([](C& c) { c.ct.critical = 1.0; })});
}

TEST(Fingerprint, SeesEveryConstantOfBonds) {
  const auto with = [](double BondLaw::*member) {
    return [member](Model& m) { m.bond_laws[0].*member = 0.7; };
  };
  expect_seen(Bonds, {with(&BondLaw::young_modulus), with(&BondLaw::stiffness_ratio),
                      with(&BondLaw::radius_factor), with(&BondLaw::damping_ratio),
                      with(&BondLaw::normal_stiffness), with(&BondLaw::tensile_strength),
                      with(&BondLaw::shear_strength)});
}

TEST(Fingerprint, SeesEveryNumberOfWallsAndStages) {
  const auto with = [](const std::function<void(WallSpec&)>& change) {
    return [change](Model& m) { change(m.walls[0]); };
  };
  using W = WallSpec;
  expect_seen(Walls,
              {with([](W& w) { w.kind = WallKind::Plate; }), with([](W& w) { w.material = 1; }),
               with([](W& w) { w.point[2] = 0.1; }), with([](W& w) { w.normal[1] = 1.0; }),
               with([](W& w) { w.velocity[0] = 1.0; }), with([](W& w) { w.width = 1.0; }),
               with([](W& w) { w.depth = 1.0; }), with([](W& w) { w.is_loaded = true; }),
               with([](W& w) { w.load = 1.0; }), with([](W& w) { w.mass = 1.0; }),
               with([](W& w) { w.damping = 1.0; }), with([](W& w) { w.from_stage = 1; })});
  expect_seen(Stages, {[](Model& m) { m.stages[0].local_damping = 0.1; },
                       [](Model& m) { m.stages[1].local_damping = 0.1; },
                       [](Model& m) { m.stages[0].max_time = 1.0; },
                       [](Model& m) { m.stages[0].kinetic_ratio = 0.1; }});
}

TEST(Fingerprint, SeesHeat) {
  const auto warm = [](const std::function<void(Model&)>& change) {
    return [change](Model& m) {
      m.heat.is_on = true;
      change(m);
    };
  };
  const std::vector<Change> changes{warm([](Model&) {}),
                                    warm([](Model& m) { m.heat.temperature = 1.0; }),
                                    warm([](Model& m) { m.materials[0].conductivity = 1.0; }),
                                    warm([](Model& m) { m.materials[0].heat_capacity = 1.0; }),
                                    warm([](Model& m) { m.walls[0].temperature = 0.0; }),
                                    warm([](Model& m) { m.walls[0].heat_flux = 1.0; })};
  expect_seen(Heat, changes);
  std::set<std::uint64_t> different;
  for (const Change& change : changes) {
    Model model = some_model();
    change(model);
    different.insert(fingerprint(model)[Heat]);
  }
  EXPECT_EQ(different.size(), changes.size());
}

TEST(Fingerprint, IsTheSameWhereARunMayGoOnDifferently) {
  Model model = some_model();
  model.title = "longer";
  model.time.num_steps = 9;
  model.stages[1].max_time = 3.0;
  model.search.skin = 0.1;
  model.limits.overlap_error = 0.3;
  model.output.series_every = 7;
  model.checkpoint.keep = 5;

  EXPECT_EQ(fingerprint(model), fingerprint(some_model()));
}

}  // namespace
}  // namespace barchan
