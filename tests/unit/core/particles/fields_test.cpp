#include <barchan/core/particles/fields.hpp>

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include <fmt/format.h>

namespace barchan {
namespace {

std::string extending() {
  std::ifstream file(std::string(BARCHAN_TREE) + "/docs/extending.md");
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(Fields, StandInTheDocumentationAsTheyAre) {
  const std::string text = extending();
  for_each_field<2>([&](const auto& field) {
    std::string unit(field.unit);
    if (field.name == "densities") unit += ", 3D kg/m³";
    const std::string row =
        fmt::format("| {} |{}{} | {} | {} |", field.name, unit.empty() ? "" : " ", unit,
                    field.is_in_halo ? "yes" : "no", field.column);
    EXPECT_NE(text.find(row), std::string::npos) << row;
  });
}

TEST(Fields, HaveColumnsOfTheirOwnThatAreTheSameInBothDimensions) {
  std::set<std::uint32_t> columns;
  std::size_t num_fields = 0;
  std::string names_2d, names_3d;
  for_each_field<2>([&](const auto& field) {
    columns.insert(field.column);
    names_2d += fmt::format("{} {}, ", field.name, field.column);
    ++num_fields;
  });
  for_each_field<3>(
      [&](const auto& field) { names_3d += fmt::format("{} {}, ", field.name, field.column); });
  EXPECT_EQ(columns.size(), num_fields);
  EXPECT_EQ(names_2d, names_3d);
}

/// What no field covers would be lost in a checkpoint, what two cover would be saved twice.
template <int Dim>
void expect_fields_apart() {
  std::set<const void*> places;
  ParticleStore<Dim> store;
  store.num_owned = 1;
  store.has_heat = true;
  store.resize_for_ghosts();
  store.external.assign(Layout<Dim>::kForce, 0.0);
  int numbers = 0;
  for_each_field<Dim>([&](const auto& field) {
    for (int c = 0; c < field.width; ++c) {
      places.insert(field.of(store, 0) + c);
      ++numbers;
    }
  });
  EXPECT_EQ(places.size(), static_cast<std::size_t>(numbers));
  int has = 0;
  for_each_array<Dim>([&](const auto& array) { has += array.width; });
  EXPECT_EQ(numbers, has - 2) << "all but the cell, which follows from the position, and 1/r, "
                                 "which follows from the radius";
}

TEST(Fields, CoverEveryNumberOfARowOnce) {
  expect_fields_apart<2>();
  expect_fields_apart<3>();
}

}  // namespace
}  // namespace barchan
