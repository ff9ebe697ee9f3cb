#include <barchan/core/base/error.hpp>

#include <utility>

namespace barchan {
namespace {

std::string describe(const SourcePlace& place, const std::string& what, const std::string& remedy) {
  std::string text = place.file;
  if (place.line > 0) text += ":" + std::to_string(place.line);
  if (place.column > 0) text += ":" + std::to_string(place.column);
  if (!text.empty()) text += ": ";
  text += what;
  if (!remedy.empty()) text += " (" + remedy + ")";
  return text;
}

}  // namespace

InputError::InputError(SourcePlace place, const std::string& what, const std::string& remedy)
    : std::runtime_error(describe(place, what, remedy)), place_(std::move(place)) {}

InputError::InputError(const std::string& what, const std::string& remedy)
    : InputError(SourcePlace{}, what, remedy) {}

}  // namespace barchan
