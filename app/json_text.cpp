#include <barchan/app/json_text.hpp>

#include <filesystem>

#include <barchan/core/base/error.hpp>
#include <barchan/core/io/text_file.hpp>

namespace barchan::app {

Json parsed(std::string_view text) {
  return Json::parse(text, nullptr, false);
}

std::string compact_text(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string indented_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

Json read_json(const std::string& path) {
  if (!std::filesystem::exists(path)) return {};
  Json json = parsed(read_text_file(path));
  if (json.is_object()) return json;
  throw InputError(SourcePlace{path, 0, 0}, "is no JSON of barchan", "remove it, or run again");
}

void write_json(const std::string& path, const Json& json) {
  OutputFile file(path);
  file.write(indented_text(json) + "\n");
  file.commit();
}

double number_in(const Json& object, const char* key) {
  const auto it = object.find(key);
  return it != object.end() && it->is_number() ? it->get<double>() : 0.0;
}

Json object_in(const Json& object, const char* key) {
  const auto it = object.find(key);
  return it != object.end() && it->is_object() ? *it : Json::object();
}

}  // namespace barchan::app
