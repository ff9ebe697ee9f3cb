#include <barchan/core/checkpoint/check_share.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <barchan/core/base/error.hpp>
#include <barchan/core/base/exact_sum.hpp>
#include <barchan/core/laws/laws.hpp>
#include <barchan/core/links/bonds.hpp>
#include <barchan/core/links/wall_shape.hpp>
#include <barchan/core/particles/layout.hpp>
#include <barchan/core/particles/share_columns.hpp>

namespace barchan {
namespace {

/// Values per particle, contact or bond.
struct Widths {
  std::size_t springs, bond_state;
};

template <int Dim>
Widths widths(int law) {
  return {static_cast<std::size_t>(history_in<Dim>(law).length), Bond<Dim>::kState};
}

class Check {
 public:
  explicit Check(const std::string& file) : file_(file) {}

  void require(bool is_right, const std::string& what) const {
    if (is_right) return;
    throw InputError(SourcePlace{file_, 0, 0}, what, "take another checkpoint");
  }
  void size(CheckpointColumn column, std::size_t has, std::size_t expected) const {
    require(has == expected, "the column " + name_of(column) + " has " + std::to_string(has) +
                                 " values instead of " + std::to_string(expected));
  }
  void finite(CheckpointColumn column, const std::vector<double>& values) const {
    const bool all =
        std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
    require(all, "the column " + name_of(column) + " has values that are not finite");
  }
  template <class T>
  void below(CheckpointColumn column, const std::vector<T>& values, std::size_t end) const {
    const bool all = std::all_of(values.begin(), values.end(), [end](T v) {
      return v >= T{0} && static_cast<std::size_t>(v) < end;
    });
    require(all, "the column " + name_of(column) + " names something that the deck does not have");
  }
  /// Carried digits and counts, small enough to add up over any number of files.
  void totals(const std::vector<std::int64_t>& values) const {
    constexpr std::int64_t kMost = std::int64_t{1} << 50;
    const bool all =
        std::all_of(values.begin(), values.end(), [](auto v) { return v >= -kMost && v <= kMost; });
    require(all, "the column totals has values that are out of range");
  }

 private:
  const std::string& file_;
};

/// Of a field, by what a share calls it.
template <class T>
CheckpointColumn column_of(std::vector<T> CheckpointShare::*saved) {
  std::uint32_t found = 0;
  for_each_field<3>([&](const auto& field) {
    if constexpr (std::is_same_v<std::decay_t<decltype(field.saved)>, decltype(saved)>)
      if (field.saved == saved) found = field.column;
  });
  return static_cast<CheckpointColumn>(found);
}

template <int Dim>
void check_particles(const CheckpointShare& s, const ShareLimits& limits, const Check& check) {
  const std::size_t n = s.ids.size();
  check.require(n < static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()) - 8,
                "too many particles in one share");
  for_each_field<Dim>([&](const auto& field) {
    const auto& values = s.*field.saved;
    const auto column = static_cast<CheckpointColumn>(field.column);
    const std::size_t rows = field.array.is_of_heat && !limits.has_heat ? 0 : n;
    if (!field.array.is_optional || !values.empty())
      check.size(column, values.size(), rows * static_cast<std::size_t>(field.width));
  });
  check.size(CheckpointColumn::Carried, s.carried.size(),
             n * static_cast<std::size_t>(limits.num_carried));
  for (const auto column :
       {&CheckpointShare::positions, &CheckpointShare::radii, &CheckpointShare::temperatures})
    check.finite(column_of(column), s.*column);
  check.below(column_of(&CheckpointShare::types), s.types, limits.num_materials);
}

void check_links(const CheckpointShare& s, const Widths& w, const ShareLimits& limits,
                 const Check& check) {
  using C = CheckpointColumn;
  const std::size_t contacts = s.contact_ids.size() / 2, walls = s.wall_contact_ids.size(),
                    bonds = s.bond_laws.size();
  check.size(C::ContactIds, s.contact_ids.size(), 2 * contacts);
  check.size(C::ContactSprings, s.contact_springs.size(), contacts * w.springs);
  check.size(C::WallContactWalls, s.wall_contact_walls.size(), walls);
  check.size(C::WallContactImages, s.wall_contact_images.size(), walls * WallImage().size());
  check.size(C::WallContactSprings, s.wall_contact_springs.size(), walls * w.springs);
  check.below(C::WallContactWalls, s.wall_contact_walls, limits.num_walls);
  const bool are_near =
      std::all_of(s.wall_contact_images.begin(), s.wall_contact_images.end(),
                  [](std::int32_t v) { return v > -kFarthestImage && v < kFarthestImage; });
  check.require(are_near, "the column wall contact images has values that are out of range");
  check.size(C::BondIds, s.bond_ids.size(), 2 * bonds);
  check.size(C::BondLengths, s.bond_lengths.size(), bonds);
  check.size(C::BondStates, s.bond_states.size(), bonds * w.bond_state);
  check.below(C::BondLaws, s.bond_laws, limits.num_bond_laws);
}

}  // namespace

void check_share(const CheckpointShare& share, const ShareLimits& limits, const std::string& file) {
  const Check check(file);
  if (limits.dimension == 2) check_particles<2>(share, limits, check);
  if (limits.dimension == 3) check_particles<3>(share, limits, check);
  const Widths w = limits.dimension == 2 ? widths<2>(limits.law) : widths<3>(limits.law);
  check_links(share, w, limits, check);
  check.size(CheckpointColumn::Totals, share.totals.size(), num_totals(limits.num_walls));
  check.totals(share.totals);
}

}  // namespace barchan
