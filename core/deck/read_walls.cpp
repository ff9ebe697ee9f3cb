// Bond laws and walls.
#include <cmath>

#include <fmt/format.h>

#include <barchan/core/deck/readers.hpp>

namespace barchan::deck {

namespace {

BondLaw read_bond(const TableReader& table) {
  BondLaw law;
  law.name = table.string("name");
  if (!table.has_one_of("young_modulus", "normal_stiffness")) {
    table.fail("name", fmt::format("bond '{}' has no stiffness", law.name),
               "add young_modulus in Pa or normal_stiffness in Pa/m");
  }
  law.young_modulus = table.optional_number("young_modulus").value_or(0.0);
  law.normal_stiffness = table.optional_number("normal_stiffness").value_or(0.0);
  law.stiffness_ratio = table.number("stiffness_ratio");
  law.radius_factor = table.number("radius_factor");
  law.damping_ratio = table.number("damping_ratio");
  law.tensile_strength = table.optional_number("tensile_strength").value_or(law.tensile_strength);
  law.shear_strength = table.optional_number("shear_strength").value_or(law.shear_strength);
  return law;
}

Vec3 read_normal(const TableReader& table) {
  const Vec3 normal = table.vector("normal");
  const double largest = normal.cwiseAbs().maxCoeff();
  if (largest == 0.0)
    table.fail("normal", "normal is the zero vector", "point it from the wall to the particles");
  return (normal / largest).normalized();  // safe for the longest and shortest vectors
}

void refuse_on(const TableReader& table, std::initializer_list<const char*> keys,
               const std::string& what, const std::string& remedy) {
  for (const char* key : keys) {
    if (table.has(key)) table.fail(key, fmt::format("{} on {}", key, what), remedy);
  }
}

double required(const TableReader& table, const char* key, const std::string& what) {
  const auto number = table.optional_number(key);
  if (!number)
    table.fail("name", fmt::format("{} lacks the key '{}'", what, key), fmt::format("add {}", key));
  return *number;
}

void read_plate(const TableReader& table, WallSpec& wall) {
  wall.kind = WallKind::Plate;
  wall.width = required(table, "width", "a plate");
  if (table.dimension() == 3) {
    wall.depth = required(table, "depth", "a plate in 3D");
  } else {
    refuse_on(table, {"depth"}, "a plate in 2D", "remove it: in 2D a plate has unit depth");
  }
  if (!table.has("load")) {
    refuse_on(table, {"mass", "damping"}, "a plate without load",
              "add load, or remove it: the velocity is given");
    return;
  }
  wall.is_loaded = true;
  wall.load = table.optional_number("load").value_or(0.0);
  wall.mass = required(table, "mass", "a loaded plate");
  wall.damping = table.number("damping");
}

WallSpec read_wall(const TableReader& table, const DeckDraft& draft) {
  WallSpec wall;
  wall.name = table.string("name");
  wall.material = draft.materials.at(table.string("material"), table.place("material"));
  wall.point = table.vector("point");
  wall.normal = read_normal(table);
  wall.velocity = table.vector("velocity");
  wall.place = table.place();
  table.has_one_of("temperature", "heat_flux");
  wall.temperature = heat_number(table, "temperature", draft.deck.model);
  wall.heat_flux = heat_number(table, "heat_flux", draft.deck.model);
  if (const auto stage = table.optional_string("from_stage")) {
    wall.from_stage = draft.stages.at(*stage, table.place("from_stage"));
  }
  if (table.string("kind") == "plate") {
    read_plate(table, wall);
  } else {
    refuse_on(table, {"width", "depth", "load", "mass", "damping"}, "a plane",
              "remove it, or write kind = \"plate\"");
  }
  return wall;
}

}  // namespace

void read_bonds(const TableReader& root, DeckDraft& draft) {
  for (const Node* node : root.tables("bond")) {
    const TableReader table(*node, root.dimension(), "[[bond]]");
    draft.deck.model.bond_laws.push_back(read_bond(table));
    draft.bonds.add(draft.deck.model.bond_laws.back().name, table.place("name"));
  }
}

void read_walls(const TableReader& root, DeckDraft& draft) {
  for (const Node* node : root.tables("wall")) {
    const TableReader table(*node, root.dimension(), "[[wall]]");
    draft.deck.model.walls.push_back(read_wall(table, draft));
    draft.walls.add(draft.deck.model.walls.back().name, table.place("name"));
  }
}

}  // namespace barchan::deck
