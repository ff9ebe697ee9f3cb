#include <barchan/core/deck/table_reader.hpp>

#include <algorithm>
#include <charconv>
#include <span>
#include <stdexcept>

#include <fmt/format.h>

#include <barchan/core/base/nearest.hpp>
#include <barchan/core/deck/not_modelled.hpp>
#include <barchan/core/deck/values.hpp>

namespace barchan::deck {

namespace {

template <class Number>
Number parse_default(const KeySpec& spec) {
  Number value{};
  const char* end = spec.default_value.data() + spec.default_value.size();
  if (std::from_chars(spec.default_value.data(), end, value).ptr != end) {
    throw std::logic_error(
        fmt::format("schema: {} {} has no default to read", spec.table, spec.key));
  }
  return value;
}

/// Two letters off in a long word are a slip; more are another word.
bool is_misspelt(std::string_view word, std::span<const std::string_view> known) {
  const std::string_view best = nearest(word, known);
  return !best.empty() && edit_distance(word, best) <= std::min<std::size_t>(2, word.size() / 4);
}

}  // namespace

TableReader::TableReader(const Node& node, int dimension, std::string_view table,
                         std::string_view more)
    : node_(node), dimension_(dimension), table_(table), more_(more) {
  if (node.kind != Node::Kind::Table)
    fail_type(node, table, "a table", "write { key = value, ... } or a header");
  for (const Node::Member& member : node.members) {
    if (!find_key(table, member.key) && (more.empty() || !find_key(more, member.key)))
      refuse_unknown(member);
  }
}

void TableReader::refuse_unknown(const Node::Member& member) const {
  std::vector<std::string_view> known;
  std::string elsewhere;
  for (const KeySpec& spec : key_specs()) {
    const bool is_here = spec.table == table_ || (!more_.empty() && spec.table == more_);
    if (is_here) known.push_back(spec.key);
    if (spec.key != member.key) continue;
    elsewhere += elsewhere.empty() ? "" : " and ";
    elsewhere += spec.table;
  }
  const std::string where = table_ == "deck" ? "at the top level" : fmt::format("in {}", table_);
  const auto left_out = find_not_modelled(table_, member.key);
  if (left_out && !is_misspelt(member.key, known)) {
    throw InputError(member.place,
                     fmt::format("{} {}: {} not modelled", member.key, where, left_out->physics),
                     std::string(left_out->instead));
  }
  std::string remedy = suggest(member.key, known);
  if (!elsewhere.empty()) remedy += fmt::format("; {} is a key of {}", member.key, elsewhere);
  throw InputError(member.place,
                   fmt::format("unknown key '{}' {}{}", member.key, where,
                               more_.empty() ? "" : fmt::format(" of kind {}", more_)),
                   remedy);
}

const KeySpec& TableReader::spec(std::string_view key) const {
  const KeySpec* found = find_key(table_, key);
  if (!found && !more_.empty()) found = find_key(more_, key);
  if (!found) throw std::logic_error(fmt::format("schema: {} has no key {}", table_, key));
  return *found;
}

const Node* TableReader::value(std::string_view key) const {
  const KeySpec& known = spec(key);
  const Node::Member* member = node_.find(key);
  if (!member && known.default_value == "required") fail_missing(known);
  return member ? &member->value : nullptr;
}

void TableReader::fail_missing(const KeySpec& missing) const {
  const std::string where = table_ == "deck" ? "the deck" : fmt::format("{}", table_);
  throw InputError(node_.place(), fmt::format("{} lacks the key '{}'", where, missing.key),
                   fmt::format("add {} ({}{}{}): {}", missing.key, type_text(missing),
                               missing.unit.empty() ? "" : " in ", missing.unit, missing.meaning));
}

SourcePlace TableReader::place(std::string_view key) const {
  const Node::Member* member = node_.find(key);
  return member ? member->value.place() : node_.place();
}

void TableReader::fail(std::string_view key, const std::string& what,
                       const std::string& remedy) const {
  throw InputError(place(key), what, remedy);
}

bool TableReader::has_one_of(std::string_view first, std::string_view second) const {
  if (has(first) && has(second)) {
    fail(second, fmt::format("{} has both {} and {}", table_, first, second), "keep one of them");
  }
  return has(first) || has(second);
}

std::optional<double> TableReader::optional_number(std::string_view key) const {
  const Node* found = value(key);
  if (!found) return std::nullopt;
  return checked_number(*found, spec(key));
}

double TableReader::number(std::string_view key) const {
  const auto found = optional_number(key);
  return found ? *found : parse_default<double>(spec(key));
}

std::optional<std::int64_t> TableReader::optional_integer(std::string_view key) const {
  const Node* found = value(key);
  if (!found) return std::nullopt;
  return checked_integer(*found, spec(key));
}

std::int64_t TableReader::integer(std::string_view key) const {
  const auto found = optional_integer(key);
  return found ? *found : parse_default<std::int64_t>(spec(key));
}

bool TableReader::boolean(std::string_view key) const {
  const Node* found = value(key);
  if (!found) return spec(key).default_value == "true";
  if (found->kind != Node::Kind::Boolean)
    fail_type(*found, key, "a boolean", "write true or false");
  return found->boolean;
}

std::optional<std::string> TableReader::optional_string(std::string_view key) const {
  const Node* found = value(key);
  if (!found) return std::nullopt;
  return checked_string(*found, spec(key));
}

std::string TableReader::string(std::string_view key) const {
  const auto found = optional_string(key);
  return found ? *found : std::string(spec(key).default_value);
}

Vec3 TableReader::vector(std::string_view key) const {
  const Node* found = value(key);
  return found ? finite_vector(*found, dimension_, key) : Vec3(Vec3::Zero());
}

Vec3 TableReader::spin(std::string_view key) const {
  const Node* found = value(key);
  if (!found) return Vec3::Zero();
  if (dimension_ == 3) return finite_vector(*found, 3, key);
  return {0.0, 0.0, finite_number(*found, key)};
}

std::vector<std::string> TableReader::names(std::string_view key) const {
  const Node* found = value(key);
  if (!found) return {};
  if (found->kind != Node::Kind::Array)
    fail_type(*found, key, "an array of strings", "write [\"...\", \"...\"]");
  std::vector<std::string> words;
  for (const Node& item : found->items) {
    if (item.kind != Node::Kind::String)
      fail_type(item, key, "a string", "write it in double quotes");
    words.push_back(item.text);
  }
  return words;
}

std::vector<const Node*> TableReader::tables(std::string_view key) const {
  const Node* found = value(key);
  if (!found) return {};
  if (found->kind != Node::Kind::Array) {
    fail_type(*found, key, "an array of tables",
              table_ == "deck" ? fmt::format("head each with [[{}]]", key)
                               : fmt::format("write {} = [{{ ... }}, ...]", key));
  }
  std::vector<const Node*> nodes;
  for (const Node& item : found->items) {
    if (item.kind != Node::Kind::Table)
      fail_type(item, key, "a table", "write { key = value, ... }");
    nodes.push_back(&item);
  }
  return nodes;
}

const Node* TableReader::table(std::string_view key) const {
  const Node* found = value(key);
  if (found && found->kind != Node::Kind::Table) {
    fail_type(*found, key, "a table",
              "write { key = value, ... } or a header with its name in brackets");
  }
  return found;
}

}  // namespace barchan::deck
