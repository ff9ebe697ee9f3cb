#include <barchan/core/deck/name_index.hpp>

#include <fmt/format.h>

#include <barchan/core/base/nearest.hpp>

namespace barchan::deck {

void NameIndex::add(const std::string& name, const SourcePlace& place) {
  const auto [entry, is_new] = indices_.emplace(name, size());
  if (!is_new) {
    throw InputError(place, fmt::format("a second {} is named '{}'", what_, name),
                     fmt::format("the first stands in line {}; give each its own name",
                                 places_[entry->second].line));
  }
  places_.push_back(place);
}

int NameIndex::at(const std::string& name, const SourcePlace& place) const {
  if (const auto entry = indices_.find(name); entry != indices_.end()) return entry->second;
  std::vector<std::string_view> known;
  for (const auto& [word, index] : indices_) known.push_back(word);
  throw InputError(place, fmt::format("unknown {} '{}'", what_, name), suggest(name, known));
}

}  // namespace barchan::deck
