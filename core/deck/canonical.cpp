#include <barchan/core/deck/canonical.hpp>

#include <xxhash.h>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace barchan::deck {
namespace {

constexpr std::size_t kMostKeys = 100;
constexpr std::size_t kLongest = 200;  // bytes of a value

std::string hash_text(const std::string& text) {
  return fmt::format("#{:016x}", XXH3_64bits(text.data(), text.size()));
}

bool has_tables(const Node& node) {
  return !node.items.empty() && node.items.front().kind == Node::Kind::Table;
}

std::string value_text(const Node& node) {
  switch (node.kind) {
    case Node::Kind::String:
      return '"' + node.text + '"';
    case Node::Kind::Integer:
      return fmt::format("{}", node.integer);
    case Node::Kind::Float:
      return fmt::format("{}", node.number);
    case Node::Kind::Boolean:
      return node.boolean ? "true" : "false";
    case Node::Kind::Array:
      break;
    default:
      return node.text;
  }
  std::string text = "[";
  for (const Node& item : node.items) text += (text.size() > 1 ? ", " : "") + value_text(item);
  return text + "]";
}

void add(const std::string& path, const Node& node, std::vector<SourceKey>& keys) {
  const std::string prefix = path.empty() ? "" : path + ".";
  if (node.kind == Node::Kind::Table) {
    for (const Node::Member& member : node.members) add(prefix + member.key, member.value, keys);
  } else if (node.kind == Node::Kind::Array && has_tables(node)) {
    for (std::size_t i = 0; i < node.items.size(); ++i)
      add(prefix + std::to_string(i + 1), node.items[i], keys);
  } else {
    std::string text = value_text(node);
    if (text.size() > kLongest) text = text.substr(0, kLongest / 2) + "... " + hash_text(text);
    keys.push_back({path, std::move(text)});
  }
}

}  // namespace

std::vector<SourceKey> canonical_keys(const Node& table) {
  std::vector<SourceKey> keys;
  add("", table, keys);
  const auto order = [](const SourceKey& k) {  // what lies deep in the table may be much: last
    return std::pair(std::count(k.key.begin(), k.key.end(), '.') > 1, std::string_view(k.key));
  };
  std::sort(keys.begin(), keys.end(),
            [&](const SourceKey& a, const SourceKey& b) { return order(a) < order(b); });
  if (keys.size() <= kMostKeys) return keys;
  std::string rest;
  for (std::size_t k = kMostKeys; k < keys.size(); ++k)
    rest += keys[k].key + '=' + keys[k].value + '\n';
  keys.resize(kMostKeys);
  keys.push_back({"further values", hash_text(rest)});
  return keys;
}

}  // namespace barchan::deck
