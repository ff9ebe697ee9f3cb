// Materials and the contact constants of every pair that can meet.
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <barchan/core/deck/readers.hpp>
#include <barchan/core/restitution.hpp>
#include <barchan/core/validate.hpp>

namespace barchan::deck {

namespace {

struct Rules {
  bool is_mixed = true;    ///< pairs without a [[pair]] take the constants of their materials
  bool no_tension = true;  ///< the clamp of the run
};

Dashpot read_normal_dashpot(const TableReader& table) {
  table.has_one_of("normal_damping", "normal_damping_rate");
  table.has_one_of("normal_damping", "restitution");
  table.has_one_of("normal_damping_rate", "restitution");
  Dashpot dashpot;
  dashpot.constant = table.number("normal_damping");
  dashpot.rate = table.optional_number("normal_damping_rate").value_or(0.0);
  return dashpot;
}

Dashpot read_tangential_dashpot(const TableReader& table) {
  table.has_one_of("tangential_damping", "tangential_damping_rate");
  Dashpot dashpot;
  dashpot.constant = table.number("tangential_damping");
  dashpot.rate = table.optional_number("tangential_damping_rate").value_or(0.0);
  return dashpot;
}

ContactConstants read_constants(const TableReader& table) {
  ContactConstants constants;
  constants.kn = table.number("normal_stiffness");
  constants.kt = table.number("tangential_stiffness");
  constants.cn = read_normal_dashpot(table);
  constants.restitution = table.optional_number("restitution");
  constants.ct = read_tangential_dashpot(table);
  constants.mu = table.number("friction");
  return constants;
}

/// A material without a stiffness has no constants at all.
std::optional<ContactConstants> read_own_constants(const TableReader& table) {
  if (table.has("normal_stiffness")) return read_constants(table);
  for (const char* key :
       {"tangential_stiffness", "normal_damping", "normal_damping_rate", "restitution",
        "tangential_damping", "tangential_damping_rate", "friction"}) {
    if (table.has(key)) {
      table.fail(key, fmt::format("{} without normal_stiffness", key),
                 "add normal_stiffness to the material, or move its constants to a [[pair]]");
    }
  }
  return std::nullopt;
}

/// Two springs, or dashpots, in series, each of which gives `a` with its like.
double in_series(double a, double b) {
  return a > 0.0 && b > 0.0 ? 2.0 / (1.0 / a + 1.0 / b) : 0.0;
}

bool is_zero(const Dashpot& dashpot) {
  return dashpot.constant == 0.0 && dashpot.rate == 0.0 && dashpot.critical == 0.0;
}

/// None when both damp, but in ways that do not add up.
std::optional<Dashpot> in_series(const Dashpot& a, const Dashpot& b) {
  const Dashpot mixed{in_series(a.constant, b.constant), in_series(a.rate, b.rate),
                      in_series(a.critical, b.critical)};
  if (is_zero(mixed) && !is_zero(a) && !is_zero(b)) return std::nullopt;
  return mixed;
}

std::optional<ContactConstants> mix(const ContactConstants& a, const ContactConstants& b) {
  const auto cn = in_series(a.cn, b.cn);
  const auto ct = in_series(a.ct, b.ct);
  const bool of_two_kinds = (a.restitution && !is_zero(b.cn)) || (b.restitution && !is_zero(a.cn));
  if (!cn || !ct || of_two_kinds) return std::nullopt;
  ContactConstants mixed;
  mixed.kn = in_series(a.kn, b.kn);
  mixed.kt = in_series(a.kt, b.kt);
  mixed.cn = *cn;
  mixed.ct = *ct;
  mixed.mu = std::min(a.mu, b.mu);
  if (a.restitution && b.restitution)
    mixed.restitution = std::sqrt(*a.restitution) * std::sqrt(*b.restitution);
  mixed.is_mixed = true;
  return mixed;
}

/// Turns a restitution into the dashpot that rebounds with it.
ContactConstants solved(ContactConstants constants, bool no_tension) {
  if (constants.restitution) {
    constants.cn.critical =
        2.0 * damping_ratio_for(*constants.restitution, no_tension) * std::sqrt(constants.kn);
  }
  return constants;
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
  users.particles.assign(deck.model.materials.size(), false);
  users.walls = users.particles;
  for (const WallSpec& wall : deck.model.walls) users.walls[wall.material] = true;
  for (const ParticleSource& source : deck.sources) {
    if (const auto* list = std::get_if<ListSource>(&source.kind)) {
      for (const ParticleData& particle : list->particles) users.particles[particle.type] = true;
    } else if (source.material) {
      users.particles[*source.material] = true;
    } else {
      users.particles.assign(users.particles.size(), true);
    }
  }
  return users;
}

using PairTable = std::vector<std::optional<ContactConstants>>;

class ContactBuilder {
 public:
  ContactBuilder(const TableReader& root, DeckDraft& draft)
      : root_(root),
        draft_(draft),
        num_(draft.deck.model.materials.size()),
        explicit_(num_ * num_) {}

  void read_own() {
    for (const Node* node : root_.tables("material")) {
      own_.push_back(read_own_constants(TableReader(*node, root_.dimension(), "[[material]]")));
    }
  }

  void read_pairs() {
    for (const Node* node : root_.tables("pair"))
      read_pair(TableReader(*node, root_.dimension(), "[[pair]]"));
  }

  ContactTable build(const Rules& rules) const {
    const Users users = find_users(draft_.deck);
    ContactTable table;
    table.num_materials = static_cast<int>(num_);
    table.no_tension = rules.no_tension;
    table.constants.resize(num_ * num_);
    for (std::size_t a = 0; a < num_; ++a) {
      for (std::size_t b = a; b < num_; ++b) {
        const auto constants = find(a, b, rules.is_mixed && users.can_meet(a, b));
        if (!constants && users.can_meet(a, b)) fail_missing(a, b, rules.is_mixed);
        table.constants[a * num_ + b] = table.constants[b * num_ + a] =
            solved(constants.value_or(ContactConstants{}), rules.no_tension);
      }
    }
    return table;
  }

 private:
  void read_pair(const TableReader& table) {
    const auto names = table.names("materials");
    if (names.size() != 2) {
      table.fail("materials", fmt::format("materials holds {} names, expected 2", names.size()),
                 "name two materials, or one twice");
    }
    const auto a =
        static_cast<std::size_t>(draft_.materials.at(names[0], table.place("materials")));
    const auto b =
        static_cast<std::size_t>(draft_.materials.at(names[1], table.place("materials")));
    if (explicit_[a * num_ + b]) {
      table.fail("materials", fmt::format("a second [[pair]] of '{}' and '{}'", names[0], names[1]),
                 "keep one");
    }
    explicit_[a * num_ + b] = explicit_[b * num_ + a] = read_constants(table);
  }

  [[nodiscard]] std::optional<ContactConstants> find(std::size_t a, std::size_t b,
                                                     bool is_mixed) const {
    if (explicit_[a * num_ + b]) return explicit_[a * num_ + b];
    if (a == b) return own_[a];
    if (!is_mixed || !own_[a] || !own_[b]) return std::nullopt;
    const auto mixed = mix(*own_[a], *own_[b]);
    if (!mixed) {
      throw InputError(
          draft_.materials.place(static_cast<int>(b)),
          fmt::format("{} give their damping in different ways, which do not mix", pair_name(a, b)),
          fmt::format("give both a coefficient, both a rate or both a restitution, or add a {}",
                      pair_text(a, b)));
    }
    return mixed;
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
  PairTable explicit_;
  PairTable own_;
};

}  // namespace

void read_material_names(const TableReader& root, DeckDraft& draft) {
  for (const Node* node : root.tables("material")) {
    const TableReader table(*node, root.dimension(), "[[material]]");
    Material material;
    material.name = table.string("name");
    material.density = table.number("density");
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
  Rules rules;
  if (const Node* node = root.table("contact")) {
    const TableReader table(*node, root.dimension(), "[contact]");
    rules.is_mixed = table.string("mixing") == "harmonic";
    rules.no_tension = table.boolean("no_tension");
  }
  draft.deck.model.contacts = builder.build(rules);
}

}  // namespace barchan::deck
