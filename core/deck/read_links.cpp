#include <barchan/core/deck/read_links.hpp>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/deck/values.hpp>

namespace barchan::deck {

namespace {

std::pair<std::int64_t, std::int64_t> read_pair(const Node& node) {
  const bool is_pair = node.kind == Node::Kind::Array && node.items.size() == 2;
  if (!is_pair) fail_type(node, "a pair", "two ids", "write [1, 2]");
  const std::int64_t a = whole_number(node.items[0], "an id");
  const std::int64_t b = whole_number(node.items[1], "an id");
  if (a < 1 || b < 1 || a == b)
    throw InputError(node.place(), fmt::format("[{}, {}] is no pair of particles", a, b),
                     "ids count from 1, and the two differ");
  return {a, b};
}

}  // namespace

BondLinks read_links(const TableReader& table) {
  BondLinks links;
  links.place = table.place("bond");
  for (const char* key : {"bond_gap", "bond_pairs"}) {
    if (!table.has(key)) continue;
    links.place = table.place(key);
    if (!table.has("bond"))
      table.fail(key, fmt::format("{} without bond", key), "name a bond law: bond = \"...\"");
  }
  if (!table.has_one_of("bond_gap", "bond_pairs")) return links;
  links.gap = table.optional_number("bond_gap");
  const Node* pairs = table.value("bond_pairs");
  if (pairs == nullptr) return links;
  if (pairs->kind != Node::Kind::Array)
    fail_type(*pairs, "bond_pairs", "an array of pairs", "write [[1, 2], [2, 3]]");
  if (pairs->items.empty())
    throw InputError(pairs->place(), "bond_pairs has no pair", "write [[1, 2], [2, 3]]");
  for (const Node& item : pairs->items) links.pairs.push_back(read_pair(item));
  return links;
}

}  // namespace barchan::deck
