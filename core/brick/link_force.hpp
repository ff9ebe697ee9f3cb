#pragma once

#include <cstdint>

#include <barchan/core/base/vec.hpp>

namespace barchan {

/// What links() lists.
enum class LinkKind {
  Contacts,      ///< pairs of particles that touch, or that the law holds from afar
  WallContacts,  ///< particles that a wall pushes or holds
  Bonds          ///< whole ones
};

/// A contact or bond, and the force in it as the next step will find it.
struct LinkForce {
  std::int64_t first = 0;      ///< id; of two particles the lower one
  std::int64_t second = 0;     ///< id; of a contact with a wall its number in the deck, from 0
  Vec3 normal = Vec3::Zero();  ///< unit, from the first to the second
  double overlap = 0.0;        ///< of a bond by how much it is shorter than unstressed [m]
  double normal_force = 0.0;   ///< above zero: it pushes the two apart [N]
  Vec3 tangential_force = Vec3::Zero();  ///< on the first; the second feels the opposite [N]
};

}  // namespace barchan
