// Materials and the contact constants of every pair that can meet.
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <barchan/core/deck/readers.hpp>
#include <barchan/core/model/validate.hpp>

namespace barchan::deck {

namespace {

struct Rules {
  bool is_mixed = true;    ///< pairs without a [[pair]] take the constants of their materials
  bool no_tension = true;  ///< the clamp of the run
};

/// Refuses two keys where only one may stand.
template <class Law>
void check_alternatives(const TableReader& table) {
  const auto group = [](std::size_t k) {
    return Law::kKeys[k].instead_of >= 0 ? Law::kKeys[k].instead_of : static_cast<int>(k);
  };
  for (std::size_t k = 0; k < Law::kKeys.size(); ++k) {
    for (std::size_t other = k + 1; other < Law::kKeys.size(); ++other) {
      if (group(k) == group(other)) table.has_one_of(Law::kKeys[k].name, Law::kKeys[other].name);
    }
  }
}

template <class Law>
ContactConstants read_constants_of(const TableReader& table) {
  check_alternatives<Law>(table);
  ContactConstants constants;
  for (const auto& key : Law::kKeys) {
    if (const auto value = table.optional_number(key.name)) key.set(constants, *value);
  }
  return constants;
}

/// A material without the law's first key has no constants at all.
template <class Law>
std::optional<ContactConstants> read_own_constants_of(const TableReader& table) {
  const std::string first = Law::kKeys[0].name;
  if (table.has(first)) return read_constants_of<Law>(table);
  for (const auto& key : Law::kKeys) {
    if (table.has(key.name)) {
      table.fail(key.name, fmt::format("{} without {}", key.name, first),
                 fmt::format("add {} to the material, or move its constants to a [[pair]]", first));
    }
  }
  return std::nullopt;
}

std::optional<ContactConstants> mix(int law, const ContactConstants& a, const ContactConstants& b) {
  return with_law(law, [&]<class Law>(Law /*law*/) -> std::optional<ContactConstants> {
    const auto mixed = Law::mix(a, b);
    if (!mixed) return std::nullopt;
    ContactConstants constants;
    static_cast<typename Law::Pair&>(constants) = *mixed;
    return constants;
  });
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
      const TableReader table(*node, root_.dimension(), "[[material]]");
      own_.push_back(with_law(
          law_, [&]<class Law>(Law /*law*/) { return read_own_constants_of<Law>(table); }));
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
    table.law = law_;
    table.constants.resize(num_ * num_);
    for (std::size_t a = 0; a < num_; ++a) {
      for (std::size_t b = a; b < num_; ++b) {
        const auto constants = find(a, b, rules.is_mixed && users.can_meet(a, b));
        if (!constants && users.can_meet(a, b)) fail_missing(a, b, rules.is_mixed);
        auto& pair = table.constants[a * num_ + b];
        pair = constants.value_or(ContactConstants{});
        with_law(law_, [&]<class Law>(Law /*law*/) { Law::solve(pair, rules.no_tension); });
        table.constants[b * num_ + a] = pair;
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
    explicit_[a * num_ + b] = explicit_[b * num_ + a] =
        with_law(law_, [&]<class Law>(Law /*law*/) { return read_constants_of<Law>(table); });
  }

  [[nodiscard]] std::optional<ContactConstants> find(std::size_t a, std::size_t b,
                                                     bool is_mixed) const {
    if (explicit_[a * num_ + b]) return explicit_[a * num_ + b];
    if (a == b) return own_[a];
    if (!is_mixed || !own_[a] || !own_[b]) return std::nullopt;
    const auto mixed = mix(law_, *own_[a], *own_[b]);
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
  int law_ = 0;  ///< place in the list of laws: there is one
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
