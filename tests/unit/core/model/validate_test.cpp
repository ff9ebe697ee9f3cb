#include <barchan/core/model/validate.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// As a caller would build it, without a deck.
Model good_model(int dimension) {
  Model model;
  model.dimension = dimension;
  model.domain.hi = Vec3(4, 2, dimension == 2 ? 0 : 1);
  model.time = {1e-4, 100, false};
  model.materials = {{"sand", 1000.0}, {"clay", 900.0}};
  ContactConstants contact;
  contact.kn = 1e5;
  model.contacts = {2, {contact, contact, contact, contact}, true};
  BondLaw bond;
  bond.young_modulus = 1e6;
  model.bond_laws = {bond};
  WallSpec plate;
  plate.name = "lid";
  plate.kind = WallKind::Plate;
  plate.normal = Vec3(0, -1, 0);
  plate.width = plate.depth = plate.mass = 1.0;
  plate.is_loaded = true;
  model.walls = {plate};
  model.stages = {Stage{}};
  return model;
}

struct Spoiled {
  const char* key;
  std::function<void(Model&)> spoil;
};

TEST(Validate, TakesAGoodModel) {
  EXPECT_FALSE(find_fault(good_model(2)).has_value());
  EXPECT_FALSE(find_fault(good_model(3)).has_value());
}

TEST(Validate, NamesTheKeyOfWhatNoRunCouldWorkWith) {
  const std::vector<Spoiled> cases{
      {"dimension", [](Model& m) { m.dimension = 4; }},
      {"domain.hi", [](Model& m) { m.domain.hi[0] = 0.0; }},
      {"domain.hi", [](Model& m) { m.domain.lo[1] = kNan; }},
      {"domain.strip_axis", [](Model& m) { m.domain.strip_axis = 2; }},
      {"time.step", [](Model& m) { m.time.step = 0.0; }},
      {"time.step", [](Model& m) { m.time.step = kNan; }},
      {"time.steps", [](Model& m) { m.time.num_steps = -1; }},
      {"gravity", [](Model& m) { m.gravity[2] = -9.81; }},
      {"gravity", [](Model& m) { m.gravity[0] = kNan; }},
      {"material", [](Model& m) { m.materials.clear(); }},
      {"material",
       [](Model& m) {
         m.materials.resize(23, {"x", 1.0});
       }},
      {"material", [](Model& m) { m.contacts.constants.pop_back(); }},
      {"material.2.density", [](Model& m) { m.materials[1].density = 0.0; }},
      {"material.2.normal_stiffness", [](Model& m) { m.contacts.constants[3].kn = -1.0; }},
      {"material.1.friction", [](Model& m) { m.contacts.constants[0].mu = kNan; }},
      {"material.1.normal_damping", [](Model& m) { m.contacts.constants[0].cn.rate = -1.0; }},
      {"material.1.name", [](Model& m) { m.contacts.constants[1].kn = 2e5; }},
      {"material.1.name", [](Model& m) { m.contacts.constants[1].ct.constant = 1.0; }},
      {"contact", [](Model& m) { m.contacts.law = 99; }},
      {"contact.model", [](Model& m) { m.contacts.law = 1; }},  // disks have no Hertz law
      {"contact.reference_speed", [](Model& m) { m.contacts.reference_speed = 0.0; }},
      {"bond.1.name", [](Model& m) { m.bond_laws[0].young_modulus = 0.0; }},
      {"bond.1.radius_factor", [](Model& m) { m.bond_laws[0].radius_factor = 0.0; }},
      {"wall.1.normal", [](Model& m) { m.walls[0].normal = Vec3(0, -2, 0); }},
      {"wall.1.normal", [](Model& m) { m.walls[0].normal.setZero(); }},
      {"wall.1.normal", [](Model& m) { m.walls[0].normal = Vec3(0, 0, 1); }},
      {"wall.1.velocity", [](Model& m) { m.walls[0].velocity[2] = 1.0; }},
      {"wall.1.material", [](Model& m) { m.walls[0].material = 2; }},
      {"wall.1.from_stage", [](Model& m) { m.walls[0].from_stage = 1; }},
      {"wall.1.width", [](Model& m) { m.walls[0].width = 0.0; }},
      {"wall.1.mass", [](Model& m) { m.walls[0].mass = 0.0; }},
      {"wall.1.load", [](Model& m) { m.walls[0].kind = WallKind::Plane; }},
      {"stage", [](Model& m) { m.stages.clear(); }},
      {"stage.1.name", [](Model& m) { m.stages.push_back({}); }},
      {"stage.1.local_damping", [](Model& m) { m.stages[0].local_damping = 1.5; }},
      {"stage.1.max_time", [](Model& m) { m.stages[0].max_time = kNan; }},
      {"search.skin", [](Model& m) { m.search.skin = -0.1; }},
      {"limits.overlap_error", [](Model& m) { m.limits.overlap_error = kNan; }},
      {"limits.overlap_warning", [](Model& m) { m.limits.overlap_warning = 2.0; }},
      {"output.series_every", [](Model& m) { m.output.series_every = -1; }},
      {"checkpoint.keep", [](Model& m) { m.checkpoint.keep = 0; }},
  };
  for (const Spoiled& spoiled : cases) {
    Model model = good_model(2);
    spoiled.spoil(model);

    const auto fault = find_fault(model);

    ASSERT_TRUE(fault.has_value()) << spoiled.key;
    EXPECT_EQ(fault->key, spoiled.key) << fault->what;
    EXPECT_FALSE(fault->what.empty() || fault->remedy.empty()) << spoiled.key;
    EXPECT_THROW(validate(model), InputError) << spoiled.key;
  }
}

TEST(Validate, TakesAThirdComponentIn3D) {
  Model model = good_model(3);
  model.gravity[2] = -9.81;
  model.walls[0].normal = Vec3(0, 0, 1);
  EXPECT_FALSE(find_fault(model).has_value());
  model.walls[0].depth = 0.0;
  EXPECT_EQ(find_fault(model)->key, "wall.1.depth");
}

}  // namespace
}  // namespace barchan
