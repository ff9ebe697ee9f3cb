#include <string_view>

#include <barchan/app/json_text.hpp>
#include <barchan/app/texts/texts.hpp>
#include <barchan/core/deck/schema.hpp>

namespace barchan::app {
namespace {

using T = deck::ValueType;

Json object_of(std::string_view table);

Json array_of(const Json& items) {
  return {{"type", "array"}, {"items", items}};
}

Json numbers(int least, int most) {
  return {
      {"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", least}, {"maxItems", most}};
}

Json named(const char* table) {
  return {{"$ref", std::string("#/$defs/") + table}};
}

/// Where a table or array of tables has its keys.
Json tables_of(const deck::KeySpec& spec) {
  if (spec.key == "region") return named("box");
  if (spec.key == "holes") return array_of(named("hole"));
  if (spec.key == "particle") return array_of(named("particle"));
  if (spec.key == "particles") return array_of(named("particles"));
  const std::string key(spec.key);
  return spec.type == T::Table ? object_of("[" + key + "]")
                               : array_of(object_of("[[" + key + "]]"));
}

Json bounded(const char* type, std::initializer_list<std::pair<const char*, double>> bounds) {
  Json json{{"type", type}};
  for (const auto& [name, value] : bounds) json[name] = value;
  return json;
}

Json number_of(T type) {
  switch (type) {
    case T::PositiveNumber:
      return bounded("number", {{"exclusiveMinimum", 0}});
    case T::NonNegativeNumber:
      return bounded("number", {{"minimum", 0}});
    case T::Restitution:
      return bounded("number", {{"exclusiveMinimum", 0}, {"maximum", 1}});
    case T::Fraction:
      return bounded("number", {{"minimum", 0}, {"maximum", 1}});
    case T::ProperFraction:
      return bounded("number", {{"exclusiveMinimum", 0}, {"exclusiveMaximum", 1}});
    case T::PoissonRatio:
      return bounded("number", {{"exclusiveMinimum", -1}, {"maximum", 0.5}});
    case T::Integer:
      return bounded("integer", {});
    case T::PositiveInteger:
      return bounded("integer", {{"minimum", 1}});
    case T::NonNegativeInteger:
      return bounded("integer", {{"minimum", 0}});
    default:
      return bounded("number", {});
  }
}

Json type_of(const deck::KeySpec& spec) {
  switch (spec.type) {
    case T::Boolean:
      return {{"type", "boolean"}};
    case T::String:
      return {{"type", "string"}};
    case T::Choice: {
      Json words = Json::array();
      for (const std::string_view word : deck::split_choices(spec.choices)) words.push_back(word);
      return {{"enum", words}};
    }
    case T::Vector:
      return numbers(2, 3);
    case T::Spin:
      return {{"anyOf", {Json{{"type", "number"}}, numbers(1, 3)}}};
    case T::Names:
      return array_of({{"type", "string"}});
    case T::Radius:
      return {{"anyOf",
               {bounded("number", {{"exclusiveMinimum", 0}}), numbers(2, 2),
                array_of(named("size class"))}}};
    case T::Fixed:
      return {{"anyOf", {Json{{"type", "boolean"}}, named("box")}}};
    case T::Pairs:
      return array_of(
          {{"type", "array"}, {"items", {{"type", "integer"}}}, {"minItems", 2}, {"maxItems", 2}});
    case T::Cuts:
      return {{"anyOf", {Json{{"enum", {"auto", "strips"}}}, array_of({{"type", "integer"}})}}};
    case T::Table:
    case T::Tables:
      return tables_of(spec);
    default:
      return number_of(spec.type);
  }
}

Json described(const deck::KeySpec& spec) {
  Json json = type_of(spec);
  std::string text(spec.meaning);
  if (!spec.unit.empty()) text += " [" + std::string(spec.unit) + "]";
  text += "; default: " + std::string(spec.default_value);
  json["description"] = text;
  return json;
}

void add_keys(std::string_view table, Json& object) {
  for (const deck::KeySpec& spec : deck::key_specs()) {
    if (spec.table != table) continue;
    object["properties"][std::string(spec.key)] = described(spec);
    if (spec.default_value == "required") object["required"].push_back(spec.key);
  }
}

Json object_of(std::string_view table) {
  Json object{{"type", "object"}, {"properties", Json::object()}, {"required", Json::array()}};
  add_keys(table, object);
  object["additionalProperties"] = false;
  return object;
}

/// A source of particles has the keys of all sources and those of its kind.
Json sources() {
  Json kinds = Json::array();
  for (const char* kind : {"file", "lattice", "packing", "ring", "list"}) {
    Json object = object_of("[[particles]]");
    add_keys(kind, object);
    object["properties"]["kind"]["enum"] = {kind};
    kinds.push_back(object);
  }
  return {{"oneOf", kinds}};
}

}  // namespace

std::string deck_schema() {
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", "A deck of barchan"}};
  const Json deck = object_of("deck");
  for (const auto& [key, value] : deck.items()) schema[key] = value;
  schema["$defs"] = {{"box", object_of("box")},
                     {"hole", object_of("hole")},
                     {"particle", object_of("particle")},
                     {"size class", object_of("size class")},
                     {"particles", sources()}};
  return indented_text(schema) + "\n";
}

}  // namespace barchan::app
