#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <barchan/core/base/error.hpp>

namespace barchan::deck {

/// The names of one kind of table, in deck order: unique, and found by index.
class NameIndex {
 public:
  explicit NameIndex(std::string_view what) : what_(what) {}

  void add(const std::string& name, const SourcePlace& place);  ///< InputError on a duplicate
  [[nodiscard]] int at(const std::string& name,
                       const SourcePlace& place) const;  ///< InputError with the nearest
  [[nodiscard]] int size() const { return static_cast<int>(places_.size()); }
  [[nodiscard]] const SourcePlace& place(int index) const {
    return places_[static_cast<std::size_t>(index)];
  }

 private:
  std::string_view what_;
  std::map<std::string, int, std::less<>> indices_;
  std::vector<SourcePlace> places_;
};

}  // namespace barchan::deck
