#include <barchan/core/deck/node.hpp>

#include <algorithm>
#include <charconv>
#include <utility>

#include <fmt/format.h>

// The library takes some malformed text for a broken promise of its own: it would abort, or with
// NDEBUG trust the promise. Here it throws instead.
namespace barchan::deck {
struct BrokenPromise {};
constexpr void keep_promise(bool is_kept) {
  if (!is_kept) throw BrokenPromise{};
}
}  // namespace barchan::deck
#undef NDEBUG
#define TOML_ASSERT(promise) ::barchan::deck::keep_promise(static_cast<bool>(promise))
#include <toml++/toml.h>

#include <barchan/core/deck/text_check.hpp>

namespace barchan::deck {

namespace {

using FileName = std::shared_ptr<const std::string>;

void set_place(Node& node, const toml::source_region& region, const FileName& file) {
  node.file = file;
  node.line = static_cast<std::int64_t>(region.begin.line);
  node.column = static_cast<std::int64_t>(region.begin.column);
}

Node convert(const toml::node& source, const FileName& file);

void convert_table(const toml::table& table, const FileName& file, Node& node) {
  node.kind = Node::Kind::Table;
  for (const auto& [key, value] : table) {
    const toml::source_position at = key.source().begin;
    const SourcePlace place{*file, static_cast<std::int64_t>(at.line),
                            static_cast<std::int64_t>(at.column)};
    node.members.push_back({std::string(key.str()), place, convert(value, file)});
  }
  std::sort(node.members.begin(), node.members.end(), [](const auto& a, const auto& b) {
    return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
  });
}

void convert_scalar(const toml::node& source, Node& node) {
  if (const auto* text = source.as_string()) {
    node.kind = Node::Kind::String;
    node.text = text->get();
  } else if (const auto* integer = source.as_integer()) {
    node.kind = Node::Kind::Integer;
    node.integer = integer->get();
    node.number = static_cast<double>(integer->get());
  } else if (const auto* number = source.as_floating_point()) {
    node.kind = Node::Kind::Float;
    node.number = number->get();
  } else if (const auto* boolean = source.as_boolean()) {
    node.kind = Node::Kind::Boolean;
    node.boolean = boolean->get();
  } else {
    node.kind = Node::Kind::Date;
  }
}

Node convert(const toml::node& source, const FileName& file) {
  Node node;
  set_place(node, source.source(), file);
  if (const toml::table* table = source.as_table()) {
    convert_table(*table, file, node);
  } else if (const toml::array* array = source.as_array()) {
    node.kind = Node::Kind::Array;
    for (const toml::node& item : *array) node.items.push_back(convert(item, file));
  } else {
    convert_scalar(source, node);
  }
  return node;
}

bool is_broken(std::string_view text) {
  try {
    (void)toml::parse(text);
  } catch (const toml::parse_error&) {  // says its place by itself
  } catch (const BrokenPromise&) {
    return true;
  }
  return false;
}

/// The least number of lines that is broken: the library reads from front to back, so more lines
/// stay broken.
std::int64_t first_broken_line(std::string_view text) {
  std::vector<std::size_t> ends;  // of lines
  for (std::size_t at = text.find('\n'); at < text.size(); at = text.find('\n', at + 1)) {
    ends.push_back(at);
  }
  const auto line = std::partition_point(
      ends.begin(), ends.end(), [&](std::size_t end) { return !is_broken(text.substr(0, end)); });
  return 1 + (line - ends.begin());
}

}  // namespace

SourcePlace Node::place() const {
  return {file ? *file : std::string(), line, column};
}

const Node::Member* Node::find(std::string_view key) const {
  for (const Member& member : members) {
    if (member.key == key) return &member;
  }
  return nullptr;
}

Node::Member* Node::find(std::string_view key) {
  return const_cast<Member*>(static_cast<const Node*>(this)->find(key));
}

std::string_view kind_name(Node::Kind kind) {
  switch (kind) {
    case Node::Kind::Table:
      return "a table";
    case Node::Kind::Array:
      return "an array";
    case Node::Kind::String:
      return "a string";
    case Node::Kind::Integer:
      return "an integer";
    case Node::Kind::Float:
      return "a number";
    case Node::Kind::Boolean:
      return "a boolean";
    case Node::Kind::Date:
      return "a date or time";
  }
  return "nothing";
}

SourcePlace place_of(const Node& root, std::string_view key) {
  const Node* node = &root;
  while (!key.empty()) {
    const std::string_view part = key.substr(0, key.find('.'));
    key.remove_prefix(std::min(key.size(), part.size() + 1));
    const Node* next = nullptr;
    if (node->kind == Node::Kind::Array) {
      std::size_t number = 0;
      std::from_chars(part.data(), part.data() + part.size(), number);
      if (number >= 1 && number <= node->items.size()) next = &node->items[number - 1];
    } else if (const Node::Member* member = node->find(part)) {
      next = &member->value;
    }
    if (next == nullptr) break;
    node = next;
  }
  return node->place();
}

Node parse_toml(std::string_view text, const std::string& file_name) {
  check_text(text, file_name);
  const char* remedy = "write `key = value`, one a line, strings in double quotes";
  try {
    const toml::table table = toml::parse(text, file_name);
    return convert(table, std::make_shared<const std::string>(file_name));
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    const bool is_number = error.description().find("64 bits") != std::string_view::npos;
    throw InputError(
        {file_name, static_cast<std::int64_t>(at.line), static_cast<std::int64_t>(at.column)},
        fmt::format("this is not TOML: {}", error.description()),
        is_number ? "whole numbers go up to 9223372036854775807" : remedy);
  } catch (const BrokenPromise&) {
    throw InputError({file_name, first_broken_line(text), 0}, "this is not TOML", remedy);
  }
}

}  // namespace barchan::deck
