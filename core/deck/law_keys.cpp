// The law of contact that a deck chooses, and its keys.
#include <barchan/core/deck/law_keys.hpp>

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include <barchan/core/model/validate.hpp>

namespace barchan::deck {

namespace {

template <class Law>
bool has_key(const char* name) {
  return std::any_of(std::begin(Law::kKeys), std::end(Law::kKeys),
                     [&](const LawKey& key) { return std::string(key.name) == name; });
}

template <class Law>
std::string keys_of() {
  std::string names;
  for (const LawKey& key : Law::kKeys) names += (names.empty() ? "" : ", ") + std::string(key.name);
  return names;
}

/// A key of [[material]] alone has been refused in a [[pair]] already.
bool stands(const TableReader& table, const LawKey& key, bool is_pair) {
  return !(is_pair && key.is_of_material) && table.has(key.name);
}

[[noreturn]] void refuse_rolling(const TableReader& table, const LawKey& key) {
  table.fail(key.name, fmt::format("'{}' has no place where contact.rolling = \"none\"", key.name),
             "write rolling = \"spring\" in [contact], or leave it out");
}

template <class Law, class Other>
void refuse_keys_of(const TableReader& table, bool is_pair) {
  for (const LawKey& key : Other::kKeys) {
    if (has_key<Law>(key.name) || !stands(table, key, is_pair)) continue;
    if (key.is_of_rolling) refuse_rolling(table, key);
    table.fail(key.name,
               fmt::format("'{}' has no place where contact.model = \"{}\"", key.name, Law::kName),
               fmt::format("\"{}\" has {}; or write model = \"{}\" in [contact]", Law::kName,
                           keys_of<Law>(), Other::kName));
  }
}

template <class Law, class... Ls>
void refuse_others(LawList<Ls...> /*laws*/, const TableReader& table, bool is_pair) {
  (refuse_keys_of<Law, Ls>(table, is_pair), ...);
}

/// Refuses two keys where only one may stand.
template <class Law>
void check_alternatives(const TableReader& table, bool is_pair) {
  const auto group = [](std::size_t k) {
    return Law::kKeys[k].instead_of >= 0 ? Law::kKeys[k].instead_of : static_cast<int>(k);
  };
  for (std::size_t k = 0; k < Law::kKeys.size(); ++k) {
    for (std::size_t other = k + 1; other < Law::kKeys.size(); ++other) {
      if (group(k) != group(other) || (is_pair && Law::kKeys[k].is_of_material)) continue;
      table.has_one_of(Law::kKeys[k].name, Law::kKeys[other].name);
    }
  }
}

}  // namespace

std::string read_law_keys(const LawChoice& choice, const TableReader& table, ContactConstants& to) {
  const bool is_pair = table.name() == "[[pair]]";
  return with_law(choice.law, [&]<class Law>(Law /*law*/) {
    refuse_others<Law>(Laws{}, table, is_pair);
    check_alternatives<Law>(table, is_pair);
    std::string first;
    for (const LawKey& key : Law::kKeys) {
      if (!stands(table, key, is_pair)) continue;
      if (key.is_of_rolling && !choice.rolls) refuse_rolling(table, key);
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
  const bool turns = choice.rolls || choice.twists;
  while (with_law(choice.law, [&]<class Law>(Law /*law*/) {
    return model != Law::kName || turns != Law::kRolls;
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
