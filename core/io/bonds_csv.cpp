#include <array>
#include <limits>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/io/column_names.hpp>
#include <barchan/core/io/csv_table.hpp>
#include <barchan/core/io/particle_file.hpp>
#include <barchan/core/io/plain_text.hpp>

namespace barchan {
namespace {

enum Column {
  IdA,
  IdB,
  Type,
  Length,
  ShearX,
  BendingX = ShearX + 3,
  Twisting = BendingX + 3,
  kNumColumns
};

constexpr std::array<std::string_view, kNumColumns> kNames = {
    "id_a",    "id_b",      "type",      "length",    "shear_x", "shear_y",
    "shear_z", "bending_x", "bending_y", "bending_z", "twisting"};

std::vector<ColumnAlias> make_aliases() {
  std::vector<ColumnAlias> aliases{{"ida", IdA},   {"idb", IdB},       {"id1", IdA},
                                   {"id2", IdB},   {"atom1", IdA},     {"atom2", IdB},
                                   {"type", Type}, {"bondtype", Type}, {"twisting", Twisting}};
  aliases.push_back({"length", Length});
  add_vector_names(aliases, "shear", ShearX);
  add_vector_names(aliases, "bending", BendingX);
  return aliases;
}

void store(BondData& bond, int column, std::string_view field, const LineReader& lines) {
  const std::string_view name = kNames[static_cast<std::size_t>(column)];
  if (column == IdA) {
    bond.id_a = parse_whole_number(field, name, lines);
  } else if (column == IdB) {
    bond.id_b = parse_whole_number(field, name, lines);
  } else if (column == Type) {
    const std::int64_t type = parse_whole_number(field, name, lines);
    const bool fits = type >= 1 && type <= std::numeric_limits<std::int32_t>::max();
    bond.law = fits ? static_cast<std::int32_t>(type - 1) : -1;
  } else {
    const double value = parse_number(field, name, lines);
    if (column == Length) bond.length = value;
    if (column >= ShearX && column < BendingX) bond.shear[column - ShearX] = value;
    if (column >= BendingX && column < Twisting) bond.bending[column - BendingX] = value;
    if (column == Twisting) bond.twisting = value;
  }
}

}  // namespace

std::vector<BondData> parse_bonds_csv(std::string_view text, const std::string& file) {
  static const std::vector<ColumnAlias> kAliases = make_aliases();
  const PlainText plain(text, file);
  CsvTable table(plain.view(), file);
  const ColumnMap map = map_columns(table.header(), kAliases, kNames, table.lines());
  for (const int column : {IdA, IdB}) {
    if (map.has(column)) continue;
    throw InputError(
        SourcePlace{file, table.lines().number(), 0},
        fmt::format("column '{}' is missing", kNames[static_cast<std::size_t>(column)]),
        "a table of bonds names id_a,id_b and optionally type,length,shear_x,shear_y,"
        "shear_z,bending_x,bending_y,bending_z,twisting");
  }
  std::vector<BondData> bonds;
  while (table.next()) {
    BondData bond;
    for (std::size_t i = 0; i < map.columns.size(); ++i) {
      if (map.columns[i] != ColumnMap::kUnused)
        store(bond, map.columns[i], table.fields()[i], table.lines());
    }
    check_bond_row(bond, table.lines());
    bonds.push_back(bond);
  }
  return bonds;
}

void write_bonds_csv(const std::string& path, std::span<const BondData> bonds) {
  OutputFile file(path);
  std::string header;
  for (const std::string_view name : kNames) {
    if (!header.empty()) header.push_back(',');
    header += name;
  }
  file.write(header + "\n");
  for (const BondData& b : bonds) {
    std::string row = fmt::format("{},{},{},{:.17g}", b.id_a, b.id_b, b.law + 1, b.length);
    for (const Vec3* v : {&b.shear, &b.bending}) {
      for (int c = 0; c < 3; ++c) fmt::format_to(std::back_inserter(row), ",{:.17g}", (*v)[c]);
    }
    file.write(row + fmt::format(",{:.17g}\n", b.twisting));
  }
  file.commit();
}

}  // namespace barchan
