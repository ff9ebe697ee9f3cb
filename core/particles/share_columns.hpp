#pragma once

#include <barchan/core/particles/fields.hpp>
#include <barchan/core/particles/share.hpp>

namespace barchan {

/// Calls visit(CheckpointColumn, vector&) for every column.
template <class Share, class Visit>
void for_each_column(Share& share, Visit&& visit) {
  using C = CheckpointColumn;
  visit(C::Totals, share.totals);
  visit(C::Outruns, share.outruns);
  for_each_field<3>([&](const auto& field) {  // in 2D they are the same but for their widths
    visit(static_cast<C>(field.column), share.*field.saved);
  });
  visit(C::Carried, share.carried);
  visit(C::ContactIds, share.contact_ids);
  visit(C::ContactSprings, share.contact_springs);
  visit(C::WallContactIds, share.wall_contact_ids);
  visit(C::WallContactWalls, share.wall_contact_walls);
  visit(C::WallContactImages, share.wall_contact_images);
  visit(C::WallContactSprings, share.wall_contact_springs);
  visit(C::BondIds, share.bond_ids);
  visit(C::BondLaws, share.bond_laws);
  visit(C::BondLengths, share.bond_lengths);
  visit(C::BondStates, share.bond_states);
}

}  // namespace barchan
