#include <barchan/core/particles/share.hpp>

#include <barchan/core/particles/fields.hpp>
#include <barchan/core/particles/share_columns.hpp>

namespace barchan {

std::string name_of(CheckpointColumn column) {
  using C = CheckpointColumn;
  switch (column) {
    case C::State:
      return "state";
    case C::Totals:
      return "totals";
    case C::Outruns:
      return "outruns";
    case C::Carried:
      return "fields of the caller";
    case C::ContactIds:
      return "contact ids";
    case C::ContactSprings:
      return "contact springs";
    case C::WallContactIds:
      return "wall contact ids";
    case C::WallContactWalls:
      return "wall contact walls";
    case C::WallContactImages:
      return "wall contact images";
    case C::WallContactSprings:
      return "wall contact springs";
    case C::BondIds:
      return "bond ids";
    case C::BondLaws:
      return "bond laws";
    case C::BondLengths:
      return "bond lengths";
    case C::BondStates:
      return "bond states";
  }
  std::string name = "number " + std::to_string(static_cast<std::uint32_t>(column));
  for_each_field<3>([&](const auto& field) {
    if (field.column == static_cast<std::uint32_t>(column)) name = field.name;
  });
  return name;
}

void CheckpointShare::clear() {
  for_each_column(*this, [](CheckpointColumn, auto& column) { column.clear(); });
}

}  // namespace barchan
