#include <barchan/core/particles/caller_fields.hpp>

#include <algorithm>

namespace barchan {
namespace {

bool is_of_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

}  // namespace

int CallerFields::num_numbers() const {
  return all_.empty() ? 0 : all_.back().at + all_.back().components;
}

const CallerField* CallerFields::find(std::string_view name) const {
  const auto found = std::find_if(all_.begin(), all_.end(),
                                  [name](const CallerField& field) { return field.name == name; });
  return found == all_.end() ? nullptr : &*found;
}

std::string CallerFields::fault_of(std::string_view name, int components) const {
  constexpr std::size_t kLongest = CallerField::Saved().name.size() - 1;
  if (name.empty() || name.size() > kLongest || !std::all_of(name.begin(), name.end(), is_of_name))
    return "'" + std::string(name) + "' is no name: give letters, digits and _, at most " +
           std::to_string(kLongest);
  if (components < 1) return std::to_string(components) + " components: give 1 or more";
  if (const CallerField* same = find(name))
    return same->components == components
               ? ""
               : "there is a field '" + same->name + "' of " + std::to_string(same->components) +
                     " components, not " + std::to_string(components);
  if (components > kMostNumbers - num_numbers())
    return "a particle carries at most " + std::to_string(kMostNumbers) + " numbers: it has " +
           std::to_string(num_numbers()) + ", and " + std::to_string(components) + " are asked for";
  return "";
}

void CallerFields::add(std::string_view name, int components) {
  all_.push_back({std::string(name), components, num_numbers()});
}

std::vector<CallerField::Saved> CallerFields::saved() const {
  std::vector<CallerField::Saved> saved;
  for (const CallerField& field : all_) {
    CallerField::Saved& s = saved.emplace_back();
    std::copy(field.name.begin(), field.name.end(), s.name.begin());
    s.components = field.components;
  }
  return saved;
}

bool CallerFields::restore(std::span<const CallerField::Saved> saved) {
  all_.clear();
  for (const CallerField::Saved& s : saved) {
    const auto end = std::find(s.name.begin(), s.name.end(), '\0');
    const std::string name(s.name.begin(), end);
    if (end == s.name.end() || find(name) != nullptr || !fault_of(name, s.components).empty())
      return false;
    add(name, s.components);
  }
  return true;
}

}  // namespace barchan
