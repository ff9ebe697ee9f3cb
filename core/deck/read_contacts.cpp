// Materials and the contact constants of every pair that can meet.
#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <barchan/core/deck/law_keys.hpp>
#include <barchan/core/deck/readers.hpp>
#include <barchan/core/model/validate.hpp>

namespace barchan::deck {

namespace {

struct Rules {
  bool is_mixed = true;  ///< pairs without a [[pair]] take the constants of their materials
  LawChoice choice;
  ContactRules contact;
  std::optional<double> reference_speed;
};

Rules read_rules(const TableReader& root) {
  Rules rules;
  const Node* node = root.table("contact");
  if (node == nullptr) return rules;
  const TableReader table(*node, root.dimension(), "[contact]");
  rules.is_mixed = table.string("mixing") == "harmonic";
  rules.choice = read_law(table);
  rules.contact.twisting = rules.choice.twists;
  rules.contact.adhesion = rules.choice.adhesion;
  rules.contact.no_tension = table.boolean("no_tension");
  if (table.string("tangential") == "mindlin-displacement")
    rules.contact.tangential = Tangential::MindlinDisplacement;
  if (table.string("pull_off") == "peak") rules.contact.pull_off = PullOff::Peak;
  rules.reference_speed = table.optional_number("reference_speed");
  return rules;
}

std::optional<ContactConstants> mix(int law, const ContactConstants& a, const ContactConstants& b) {
  return with_law(law, [&]<class Law>(Law /*law*/) { return Law::mix(a, b); });
}

std::optional<KeyGap> find_gap(int law, const ContactConstants& constants) {
  return with_law(law, [&]<class Law>(Law /*law*/) { return Law::find_gap(constants); });
}

/// Who can touch whom: walls never touch walls.
struct Users {
  std::vector<bool> particles, walls;  ///< by material

  [[nodiscard]] bool can_meet(std::size_t a, std::size_t b) const {
    return (particles[a] && (particles[b] || walls[b])) || (walls[a] && particles[b]);
  }
};

Users find_users(const Deck& deck) {
  Users users;
  users.particles = made_into_particles(deck);
  users.walls.assign(users.particles.size(), false);
  for (const WallSpec& wall : deck.model.walls) users.walls[wall.material] = true;
  return users;
}

using PairTable = std::vector<std::optional<ContactConstants>>;

class ContactBuilder {
 public:
  ContactBuilder(const TableReader& root, DeckDraft& draft)
      : root_(root),
        draft_(draft),
        num_(draft.deck.model.materials.size()),
        rules_(read_rules(root)),
        explicit_(num_ * num_),
        bridges_(num_ * num_) {}

  void read_own() {
    for (const Node* node : root_.tables("material")) {
      const TableReader table(*node, root_.dimension(), "[[material]]");
      ContactConstants constants;
      const std::string first = read_law_keys(rules_.choice, table, constants);
      own_.push_back(first.empty() ? std::nullopt : std::optional(constants));
      if (first.empty()) continue;
      if (const auto gap = find_gap(rules_.choice.law, constants))
        table.fail(first, first + " " + gap->what, gap->remedy);
    }
  }

  void read_pairs() {
    for (const Node* node : root_.tables("pair"))
      read_pair(TableReader(*node, root_.dimension(), "[[pair]]"));
  }

  void read_bridges() {
    for (const Node* node : root_.tables("bridge"))
      read_bridge(TableReader(*node, root_.dimension(), "[[bridge]]"));
  }

  ContactTable build() const {
    const Users users = find_users(draft_.deck);
    refuse_rigid_particles(users);
    ContactTable table;
    table.num_materials = static_cast<int>(num_);
    table.no_tension = rules_.contact.no_tension;
    table.law = rules_.choice.law;
    table.tangential = rules_.contact.tangential;
    table.twisting = rules_.contact.twisting;
    table.adhesion = rules_.contact.adhesion;
    table.pull_off = rules_.contact.pull_off;
    table.reference_speed = rules_.reference_speed;
    table.constants.resize(num_ * num_);
    for (std::size_t a = 0; a < num_; ++a) {
      for (std::size_t b = a; b < num_; ++b) {
        const auto constants = find(a, b, rules_.is_mixed && users.can_meet(a, b));
        if (users.can_meet(a, b)) check_complete(a, b, constants);
        auto& pair = table.constants[a * num_ + b];
        pair = constants.value_or(ContactConstants{});
        pair.bridge = bridges_[a * num_ + b].value_or(Bridge{});
        with_law(rules_.choice.law,
                 [&]<class Law>(Law /*law*/) { Law::solve(pair, rules_.contact); });
        table.constants[b * num_ + a] = pair;
      }
    }
    refuse_idle(table);
    for (std::size_t a = 0; a < num_; ++a) {
      for (std::size_t b = a; b < num_; ++b) {
        if (users.can_meet(a, b)) refuse_without_spring(a, b, table.constants[a * num_ + b]);
      }
    }
    return table;
  }

 private:
  /// The two materials of a table, which is the first of these two in `known`.
  template <class Known>
  std::array<std::size_t, 2> read_materials(const TableReader& table, const Known& known) const {
    const auto names = table.names("materials");
    if (names.size() != 2) {
      table.fail("materials", fmt::format("materials holds {} names, expected 2", names.size()),
                 "name two materials, or one twice");
    }
    std::array<std::size_t, 2> two{};
    for (std::size_t m = 0; m < 2; ++m)
      two[m] = static_cast<std::size_t>(draft_.materials.at(names[m], table.place("materials")));
    if (known[two[0] * num_ + two[1]]) {
      table.fail("materials",
                 fmt::format("a second {} of '{}' and '{}'", table.name(), names[0], names[1]),
                 "keep one");
    }
    return two;
  }

  void read_bridge(const TableReader& table) {
    if (rules_.choice.adhesion != Adhesion::Bridge)
      table.fail("materials", "a [[bridge]] has no place without contact.adhesion = \"bridge\"",
                 "write model = \"hertz\" and adhesion = \"bridge\" in [contact], or leave it out");
    const auto [a, b] = read_materials(table, bridges_);
    const double angle = table.number("contact_angle");
    if (!(angle < 90.0))
      table.fail("contact_angle",
                 fmt::format("contact_angle = {}: such a liquid wets nothing", angle),
                 "give an angle in degrees, below 90");
    bridges_[a * num_ + b] = bridges_[b * num_ + a] = Bridge{
        table.number("surface_tension"), angle * std::numbers::pi / 180.0, table.number("volume")};
  }

  void read_pair(const TableReader& table) {
    const auto [a, b] = read_materials(table, explicit_);
    ContactConstants constants = base_of(a, b, table);
    read_law_keys(rules_.choice, table, constants);
    if (pairs_stand_alone()) {
      if (const auto gap = find_gap(rules_.choice.law, constants))
        table.fail("materials", "[[pair]] " + gap->what, gap->remedy);
    }
    if (table.has("restitution")) constants.is_mixed = false;
    explicit_[a * num_ + b] = explicit_[b * num_ + a] = constants;
  }

  [[nodiscard]] bool pairs_stand_alone() const {
    return with_law(rules_.choice.law,
                    []<class Law>(Law /*law*/) { return Law::kPairsStandAlone; });
  }

  /// What a [[pair]] begins with.
  [[nodiscard]] ContactConstants base_of(std::size_t a, std::size_t b,
                                         const TableReader& table) const {
    if (pairs_stand_alone()) return {};
    for (const std::size_t m : {a, b}) {
      if (own_[m]) continue;
      table.fail(
          "materials",
          fmt::format("'{}' has no constants of its own, from which those of the pair follow",
                      draft_.deck.model.materials[m].name),
          find_gap(rules_.choice.law, {})->remedy);
    }
    return mixed_of(a, b);
  }

  /// @pre both materials have constants
  [[nodiscard]] ContactConstants mixed_of(std::size_t a, std::size_t b) const {
    if (a == b && pairs_stand_alone()) return *own_[a];
    auto mixed = mix(rules_.choice.law, *own_[a], *own_[b]);
    if (mixed) {
      mixed->is_mixed = a != b;
      return *mixed;
    }
    throw InputError(
        draft_.materials.place(static_cast<int>(b)),
        fmt::format(
            "{} give their damping or rolling stiffness in different ways, which do not mix",
            pair_name(a, b)),
        fmt::format("give both a coefficient, both a rate or both a restitution, or add a {}",
                    pair_text(a, b)));
  }

  [[nodiscard]] std::optional<ContactConstants> find(std::size_t a, std::size_t b,
                                                     bool is_mixed) const {
    if (explicit_[a * num_ + b]) return explicit_[a * num_ + b];
    if ((a != b && !is_mixed) || !own_[a] || !own_[b]) return std::nullopt;
    return mixed_of(a, b);
  }

  /// What is chosen must act on some pair.
  void refuse_idle(const ContactTable& table) const {
    const auto has = [&](double ContactConstants::*number) {
      return std::any_of(table.constants.begin(), table.constants.end(),
                         [&](const ContactConstants& p) { return p.*number > 0.0; });
    };
    const Node* node = root_.table("contact");
    const auto fail = [&](const char* key, const char* what, const char* remedy) {
      TableReader(*node, root_.dimension(), "[contact]").fail(key, what, remedy);
    };
    if (rules_.choice.rolls && !has(&ContactConstants::mu_rolling))
      fail("rolling", "rolling = \"spring\", and no pair of materials has rolling_friction",
           "add rolling_friction to the materials, or leave rolling out");
    const Adhesion adhesion = rules_.choice.adhesion;
    if (adhesion == Adhesion::Dmt && !has(&ContactConstants::surface_energy))
      fail("adhesion", "adhesion = \"dmt\", and no pair of materials has surface_energy",
           "add surface_energy in J/m² to the materials, or leave adhesion out");
    if (adhesion == Adhesion::Bridge && root_.tables("bridge").empty())
      fail("adhesion", "adhesion = \"bridge\", and there is no [[bridge]]",
           "add a [[bridge]] with materials, surface_tension and volume, or leave adhesion out");
    if ((adhesion == Adhesion::Sjkr || adhesion == Adhesion::Sjkr2) &&
        !has(&ContactConstants::cohesion_density))
      fail("adhesion", "adhesion by area, and no pair of materials has cohesion_density",
           "add cohesion_density in J/m³ to the materials, or leave adhesion out");
    if (rules_.choice.attracts && !has(&ContactConstants::surface_energy))
      fail("model", "model = \"jkr\", and no pair of materials has surface_energy",
           "add surface_energy in J/m² to the materials, or write model = \"hertz\"");
    if (rules_.choice.twists && !has(&ContactConstants::mu))
      fail("twisting", "twisting acts by friction, and no pair of materials has friction",
           "add friction to the materials, or leave twisting out");
  }

  /// Resistance to rolling goes by the tangential spring, unless it has one of its own.
  void refuse_without_spring(std::size_t a, std::size_t b, const ContactConstants& pair) const {
    if (!rules_.choice.rolls || pair.mu_rolling == 0.0 || pair.kr > 0.0 || pair.cr > 0.0) return;
    const bool is_elastic = pair.young_star > 0.0;
    if (is_elastic ? pair.mu > 0.0 : pair.kt > 0.0) return;
    throw InputError(
        draft_.materials.place(static_cast<int>(b)),
        fmt::format(
            "contacts of {} have rolling_friction, and no stiffness to resist rolling with: "
            "{} is zero",
            pair_name(a, b), is_elastic ? "friction" : "tangential_stiffness"),
        fmt::format("give them {}, or rolling_stiffness",
                    is_elastic ? "friction" : "tangential_stiffness"));
  }

  void refuse_rigid_particles(const Users& users) const {
    for (std::size_t a = 0; a < num_; ++a) {
      if (!users.particles[a] || !own_[a] || !own_[a]->is_rigid) continue;
      throw InputError(draft_.materials.place(static_cast<int>(a)),
                       fmt::format("'{}' is rigid, and particles are made of it: rigid bodies do "
                                   "not touch elastically",
                                   draft_.deck.model.materials[a].name),
                       "give it young_modulus and poisson_ratio; rigid is for walls");
    }
  }

  void check_complete(std::size_t a, std::size_t b,
                      const std::optional<ContactConstants>& constants) const {
    if (!constants) fail_missing(a, b, rules_.is_mixed);
    const char* key = with_law(rules_.choice.law,
                               [&]<class Law>(Law /*law*/) { return Law::lacking(*constants); });
    if (key == nullptr) return;
    throw InputError(draft_.materials.place(static_cast<int>(b)),
                     fmt::format("contacts of {} have no {}", pair_name(a, b), key),
                     fmt::format("add {} to {}, or to a {}", key,
                                 a == b ? "the material" : "both materials", pair_text(a, b)));
  }

  [[noreturn]] void fail_missing(std::size_t a, std::size_t b, bool is_mixed) const {
    throw InputError(
        draft_.materials.place(static_cast<int>(b)),
        fmt::format("missing material pair: no contact constants for {}", pair_name(a, b)),
        fmt::format("add a {}{}", pair_text(a, b),
                    is_mixed || a == b ? ", or give each material its own constants" : ""));
  }

  [[nodiscard]] std::string pair_name(std::size_t a, std::size_t b) const {
    return fmt::format("'{}' and '{}'", draft_.deck.model.materials[a].name,
                       draft_.deck.model.materials[b].name);
  }

  [[nodiscard]] std::string pair_text(std::size_t a, std::size_t b) const {
    const auto& materials = draft_.deck.model.materials;
    return fmt::format("[[pair]] with materials = [\"{}\", \"{}\"]", materials[a].name,
                       materials[b].name);
  }

  const TableReader& root_;
  const DeckDraft& draft_;
  std::size_t num_;
  Rules rules_;
  PairTable explicit_;
  PairTable own_;
  std::vector<std::optional<Bridge>> bridges_;
};

}  // namespace

void read_material_names(const TableReader& root, DeckDraft& draft) {
  for (const Node* node : root.tables("material")) {
    const TableReader table(*node, root.dimension(), "[[material]]");
    Material material;
    material.name = table.string("name");
    material.density = table.number("density");
    const Model& model = draft.deck.model;
    material.conductivity = heat_number(table, "conductivity", model).value_or(0.0);
    material.heat_capacity = heat_number(table, "heat_capacity", model).value_or(0.0);
    draft.materials.add(material.name, table.place("name"));
    draft.deck.model.materials.push_back(material);
  }
  const std::size_t num = draft.deck.model.materials.size();
  if (num == 0 || num > kMostMaterials)
    root.fail("material", fmt::format("{} materials", num),
              fmt::format("give 1 to {}", kMostMaterials));
}

void read_contacts(const TableReader& root, DeckDraft& draft) {
  ContactBuilder builder(root, draft);
  builder.read_own();
  builder.read_pairs();
  builder.read_bridges();
  draft.deck.model.contacts = builder.build();
}

}  // namespace barchan::deck
