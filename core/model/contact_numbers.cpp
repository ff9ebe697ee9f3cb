#include <barchan/core/model/contact_numbers.hpp>

#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

/// What two materials have together is no longer theirs.
bool is_of_one_material(const std::string& key) {
  return key == "young_modulus" || key == "poisson_ratio";
}

}  // namespace

void set_number(const ContactTable& contacts, ContactConstants& pair, const std::string& key,
                double value) {
  with_law(contacts.law, [&]<class Law>(Law /*law*/) {
    if (key == "restitution") {
      if (!(value >= 0.0 && value <= 1.0))
        throw InputError(fmt::format("restitution = {:g}", value), "give a number from 0 to 1");
      pair.restitution = value;
      pair.cn = {};
      Law::solve(pair, contacts.rules());
      return;
    }
    std::set<std::string> known{"restitution"};
    bool is_set = false;
    Law::for_each_number(pair, [&](const char* of, double& number) {
      if (is_of_one_material(of)) return;
      known.insert(of);
      if (key != of) return;
      number = std::exchange(is_set, true) ? 0.0 : value;  // a dashpot has further parts
    });
    if (!is_set)
      throw InputError(fmt::format("contacts of this law have no '{}' of two materials", key),
                       fmt::format("there are {}", fmt::join(known, ", ")));
    if (key == "normal_damping") pair.restitution.reset();
    Law::solve(pair, contacts.rules());  // to other springs, other dashpots
  });
}

}  // namespace barchan
