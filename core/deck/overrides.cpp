#include <barchan/core/deck/overrides.hpp>

#include <charconv>
#include <optional>

#include <fmt/format.h>

#include <barchan/core/base/nearest.hpp>

namespace barchan {

DeckOverride parse_override(std::string_view argument) {
  const std::size_t equals = argument.find('=');
  if (equals == std::string_view::npos || equals == 0) {
    throw InputError(fmt::format("--set {}: expected key=value", argument),
                     "such as --set time.steps=1000");
  }
  return {std::string(argument.substr(0, equals)), std::string(argument.substr(equals + 1))};
}

namespace deck {

namespace {

std::string label(const DeckOverride& change) {
  return fmt::format("--set {}={}", change.key, change.value);
}

[[noreturn]] void fail(const DeckOverride& change, const std::string& what,
                       const std::string& remedy) {
  throw InputError({label(change), 0, 0}, what, remedy);
}

std::vector<std::string> split_key(const DeckOverride& change) {
  constexpr std::size_t kMaxParts = 16;
  std::vector<std::string> parts(1);
  for (const char c : change.key) {
    if (c == '.') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  for (const std::string& part : parts) {
    if (part.empty() || parts.size() > kMaxParts) {
      fail(change, "this is not a dotted key", "such as time.step or material.soil.friction");
    }
  }
  return parts;
}

/// Nodes of an override stand nowhere in the deck: their place is the option itself.
void relocate(Node& node, const std::shared_ptr<const std::string>& file) {
  node.file = file;
  node.line = node.column = 0;
  for (Node& item : node.items) relocate(item, file);
  for (Node::Member& member : node.members) {
    member.place = {*file, 0, 0};
    relocate(member.value, file);
  }
}

Node parse_value(const DeckOverride& change) {
  Node node;
  node.kind = Node::Kind::String;
  node.text = change.value;
  try {
    Node table = parse_toml("value = " + change.value, label(change));
    if (table.members.size() == 1) {
      Node parsed = std::move(table.members.front().value);  // not into its own ancestor
      node = std::move(parsed);
    }
  } catch (const InputError&) {  // bare words are strings
  }
  relocate(node, std::make_shared<const std::string>(label(change)));
  return node;
}

std::string_view name_of(const Node& table) {
  const Node::Member* name = table.kind == Node::Kind::Table ? table.find("name") : nullptr;
  return name && name->value.kind == Node::Kind::String ? std::string_view(name->value.text)
                                                        : std::string_view();
}

Node& find_item(Node& array, const std::string& part, const DeckOverride& change) {
  std::vector<std::string_view> names;
  for (Node& item : array.items) {
    if (const std::string_view name = name_of(item); !name.empty()) {
      if (name == part) return item;
      names.push_back(name);
    }
  }
  std::size_t number = 0;
  const char* end = part.data() + part.size();
  if (std::from_chars(part.data(), end, number).ptr == end && number >= 1 &&
      number <= array.items.size()) {
    return array.items[number - 1];
  }
  fail(change, fmt::format("no entry '{}' in an array of {}", part, array.items.size()),
       names.empty() ? std::string("entries are numbered from 1") : suggest(part, names));
}

Node& find_or_add(Node& table, const std::string& part, const DeckOverride& change) {
  if (Node::Member* member = table.find(part)) return member->value;
  Node child;
  relocate(child, std::make_shared<const std::string>(label(change)));
  table.members.push_back({part, {label(change), 0, 0}, std::move(child)});
  return table.members.back().value;
}

}  // namespace

void apply_override(Node& root, const DeckOverride& change) {
  Node* node = &root;
  for (const std::string& part : split_key(change)) {
    if (node->kind == Node::Kind::Table) {
      node = &find_or_add(*node, part, change);
    } else if (node->kind == Node::Kind::Array) {
      node = &find_item(*node, part, change);
    } else {
      fail(change, fmt::format("'{}' lies inside {}", part, kind_name(node->kind)),
           "name a key of a table of the deck");
    }
  }
  *node = parse_value(change);
}

}  // namespace deck
}  // namespace barchan
