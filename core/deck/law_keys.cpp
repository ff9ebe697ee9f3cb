// The law of contact that a deck chooses, and its keys.
#include <barchan/core/deck/law_keys.hpp>

#include <algorithm>
#include <array>
#include <iterator>
#include <type_traits>

#include <fmt/format.h>

#include <barchan/core/model/validate.hpp>

namespace barchan::deck {

namespace {

template <class Law>
bool has_key(const char* name) {
  return std::any_of(std::begin(Law::keys()), std::end(Law::keys()),
                     [&](const LawKey& key) { return std::string(key.name) == name; });
}

template <class Law>
std::string keys_of() {
  std::string names;
  for (const LawKey& key : Law::keys())
    names += (names.empty() ? "" : ", ") + std::string(key.name);
  return names;
}

/// What `keys_of` are those of.
template <class Law>
std::string title_of() {
  return Law::kIsByRadius ? Law::kChoice : fmt::format("\"{}\"", Law::kName);
}

/// What to do in [contact] for keys of the other law.
template <class Law, class Other>
std::string change_to() {
  const bool is_given = Law::kIsByRadius && std::is_same_v<Other, LinearSpring>;
  return is_given ? "leave stiffness out" : fmt::format("write {}", Other::kChoice);
}

/// A key of [[material]] alone has been refused in a [[pair]] already.
bool stands(const TableReader& table, const LawKey& key, bool is_pair) {
  return !(is_pair && key.is_of_material) && table.has(key.name);
}

/// Why a key has no place, and what would give it one; empty where only the model is wrong.
std::array<std::string, 2> choice_for(LawKey::Part part) {
  switch (part) {
    case LawKey::Part::Rolling:
      return {"rolling", "\"spring\""};
    case LawKey::Part::Dmt:
      return {"adhesion", "\"dmt\""};
    case LawKey::Part::Sjkr:
      return {"adhesion", "\"sjkr\" or \"sjkr2\""};
    case LawKey::Part::Law:
      break;
  }
  return {};
}

bool is_chosen(const LawChoice& choice, LawKey::Part part) {
  switch (part) {
    case LawKey::Part::Rolling:
      return choice.rolls;
    case LawKey::Part::Dmt:
      return choice.adhesion == Adhesion::Dmt;
    case LawKey::Part::Sjkr:
      return choice.adhesion == Adhesion::Sjkr || choice.adhesion == Adhesion::Sjkr2;
    case LawKey::Part::Law:
      break;
  }
  return true;
}

void refuse_unchosen(const LawChoice& choice, const TableReader& table, const LawKey& key) {
  if (is_chosen(choice, key.part)) return;
  const auto [chooser, wanted] = choice_for(key.part);
  table.fail(key.name,
             fmt::format("'{}' has no place without contact.{} = {}", key.name, chooser, wanted),
             fmt::format("write {} = {}{} in [contact], or leave it out", chooser, wanted,
                         key.part == LawKey::Part::Dmt ? " or model = \"jkr\"" : ""));
}

template <class Law, class Other>
void refuse_keys_of(const LawChoice& choice, const TableReader& table, bool is_pair) {
  for (const LawKey& key : Other::keys()) {
    if (has_key<Law>(key.name) || !stands(table, key, is_pair)) continue;
    refuse_unchosen(choice, table, key);
    table.fail(key.name, fmt::format("'{}' has no place where contact.{}", key.name, Law::kChoice),
               fmt::format("{} has {}; or {} in [contact]", title_of<Law>(), keys_of<Law>(),
                           change_to<Law, Other>()));
  }
}

template <class Law, class... Ls>
void refuse_others(LawList<Ls...> /*laws*/, const LawChoice& choice, const TableReader& table,
                   bool is_pair) {
  (refuse_keys_of<Law, Ls>(choice, table, is_pair), ...);
}

/// Refuses two keys where only one may stand.
template <class Law>
void check_alternatives(const TableReader& table, bool is_pair) {
  const auto group = [](std::size_t k) {
    return Law::keys()[k].instead_of >= 0 ? Law::keys()[k].instead_of : static_cast<int>(k);
  };
  for (std::size_t k = 0; k < Law::keys().size(); ++k) {
    for (std::size_t other = k + 1; other < Law::keys().size(); ++other) {
      if (group(k) != group(other) || (is_pair && Law::keys()[k].is_of_material)) continue;
      table.has_one_of(Law::keys()[k].name, Law::keys()[other].name);
    }
  }
}

Adhesion adhesion_of(const std::string& word) {
  if (word == "dmt") return Adhesion::Dmt;
  if (word == "sjkr") return Adhesion::Sjkr;
  if (word == "sjkr2") return Adhesion::Sjkr2;
  return word == "bridge" ? Adhesion::Bridge : Adhesion::None;
}

}  // namespace

std::string read_law_keys(const LawChoice& choice, const TableReader& table, ContactConstants& to) {
  const bool is_pair = table.name() == "[[pair]]";
  return with_law(choice.law, [&]<class Law>(Law /*law*/) {
    refuse_others<Law>(Laws{}, choice, table, is_pair);
    check_alternatives<Law>(table, is_pair);
    std::string first;
    for (const LawKey& key : Law::keys()) {
      if (!stands(table, key, is_pair)) continue;
      refuse_unchosen(choice, table, key);
      if (first.empty()) first = key.name;
      key.set(to, key.range == LawKey::Range::Flag ? (table.boolean(key.name) ? 1.0 : 0.0)
                                                   : table.number(key.name));
    }
    return first;
  });
}

LawChoice read_law(const TableReader& contact) {
  const std::string model = contact.string("model");
  LawChoice choice;
  choice.rolls = contact.string("rolling") != "none";
  choice.twists = contact.string("twisting") != "none";
  choice.adhesion = adhesion_of(contact.string("adhesion"));
  const bool turns = choice.rolls || choice.twists, sticks = choice.adhesion != Adhesion::None;
  choice.attracts = model == Jkr::kName;
  choice.is_by_radius = contact.string("stiffness") == "radius";
  if (model != "linear" && contact.has("stiffness"))
    contact.fail("stiffness",
                 fmt::format("'stiffness' has no place where contact.model = \"{}\"", model),
                 "leave it out: these contacts are as stiff as their moduli and radii make them");
  if (choice.attracts && sticks)
    contact.fail("adhesion", "jkr contacts have an attraction of their own",
                 "write model = \"hertz\", or leave adhesion out");
  if (!choice.attracts && contact.has("pull_off"))
    contact.fail("pull_off",
                 fmt::format("'pull_off' has no place where contact.model = \"{}\"", model),
                 "write model = \"jkr\", or leave it out");
  if (sticks && model == "linear")
    contact.fail("adhesion", "linear contacts do not stick",
                 "write model = \"hertz\", or leave adhesion out");
  while (with_law(choice.law, [&]<class Law>(Law /*law*/) {
    return model != Law::kName || turns != Law::kRolls || choice.is_by_radius != Law::kIsByRadius ||
           !Law::sticks_by(choice.adhesion);
  }))
    ++choice.law;
  if (const auto fault = find_law_fault(choice.law, choice.twists, contact.dimension()))
    contact.fail(fault->key == "contact.model" ? "model" : "twisting", fault->what, fault->remedy);
  const auto refuse = [&](const char* key, const char* remedy) {
    if (model == "linear" && contact.has(key))
      contact.fail(key, fmt::format("'{}' has no place where contact.model = \"linear\"", key),
                   remedy);
  };
  refuse("tangential", "give materials tangential_stiffness in N/m, or write model = \"hertz\"");
  refuse("reference_speed", "leave it out: a linear spring is as stiff at any speed");
  return choice;
}

}  // namespace barchan::deck
