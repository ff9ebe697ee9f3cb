#pragma once

#include <barchan/core/model/model.hpp>

namespace barchan {

/// How far beyond touch contacts of this law may hold, between particles of a largest radius or one
/// of them and a wall [m]; 0: not at all.
[[nodiscard]] double contact_range(const ContactTable& contacts, double largest_radius);

/// The range of the largest particles of which two, and their contact, fit into a distance [m].
[[nodiscard]] double contact_range_within(const ContactTable& contacts, double distance);

}  // namespace barchan
