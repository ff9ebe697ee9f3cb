#include <barchan/core/model/contact_range.hpp>

#include <algorithm>

#include <barchan/core/laws/laws.hpp>

namespace barchan {

double contact_range(const ContactTable& contacts, double largest_radius) {
  double range = 0.0;
  with_law(contacts.law, [&]<class Law>(Law /*law*/) {
    if constexpr (requires(const ContactConstants& pair, const ContactRules& rules) {
                    Law::range(pair, rules, largest_radius);
                  }) {
      for (const ContactConstants& pair : contacts.constants)
        range = std::max(range, Law::range(pair, contacts.rules(), largest_radius));
    }
  });
  return range;
}

double contact_range_within(const ContactTable& contacts, double distance) {
  double less = 0.0, more = 0.5 * distance;  // radii
  if (contact_range(contacts, more) == 0.0) return 0.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (less + more);
    (2.0 * middle + contact_range(contacts, middle) < distance ? less : more) = middle;
  }
  return distance - 2.0 * more;
}

}  // namespace barchan
