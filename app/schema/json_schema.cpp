#include "json_schema.hpp"

#include "bounds.hpp"

#include <fmt/format.h>

#include <utility>

namespace lagroid::app {

namespace {

using Json = nlohmann::ordered_json;

Json of(const Value& value);

Json array_of(const Json& items, std::size_t least) {
  return {{"type", "array"}, {"items", items}, {"minItems", least}};
}
Json array_of(const Json& items, std::size_t least, std::size_t most) {
  Json out = array_of(items, least);
  out["maxItems"] = most;
  return out;
}

Json of(const Number& number) {
  Json out{{"type", "number"}};
  const Bounds bounds = bounds_of(number.rule);
  if (bounds.least) out[bounds.least->excluded ? "exclusiveMinimum" : "minimum"] = bounds.least->value;
  if (bounds.most) out[bounds.most->excluded ? "exclusiveMaximum" : "maximum"] = bounds.most->value;
  return out;
}
Json of(const Whole& whole) { return {{"type", "integer"}, {"minimum", whole.least}, {"maximum", whole.most}}; }
Json of(const OneOf& choice) {
  if (choice.words.size() == 1) return {{"const", choice.words.front()}};
  return {{"enum", choice.words}};
}
Json of(const Text&) { return {{"type", "string"}}; }
Json of(const Texts&) { return array_of(of(Text()), 0); }
Json of(const Flag&) { return {{"type", "boolean"}}; }
Json of(const NumberArray& numbers) { return array_of(of(Number{numbers.rule}), numbers.size, numbers.size); }
Json of(const NumberList& numbers) { return array_of(of(Number{numbers.rule}), 1); }
Json of(const AnyAttitude&) { return array_of(of(Number()), 3, 4); }
Json of(const SpacePoints& points) {
  const Json point = of(NumberArray{3});
  return points.count ? array_of(point, *points.count, *points.count) : array_of(point, 1);
}
Json of(const Table& table) { return json_schema(table); }
Json of(const Tables& tables) { return array_of(json_schema(tables.each), 0); }
Json of(const AnyTable&) { return {{"type", "object"}}; }
Json of(const Either& either) {
  Json any = Json::array();
  for (const Value& value : either.values) any.push_back(of(value));
  return {{"anyOf", any}};
}
Json of(const Value& value) {
  return std::visit([](const auto& is) { return of(is); }, value.is);
}

Json of(const Key& key) {
  Json out = Json::object();
  std::string description = key.unit.empty() ? key.meaning : fmt::format("{} [{}]", key.meaning, key.unit);
  if (!key.otherwise.empty()) {
    description += fmt::format(" (default: {})", key.otherwise);
  } else if (!key.required()) {
    out["default"] = std::visit(
        [](const auto& fallback) -> Json {
          if constexpr (std::is_same_v<decltype(fallback), const std::monostate&>) {
            return nullptr;
          } else {
            return fallback;
          }
        },
        key.fallback);
  }
  if (!description.empty()) out["description"] = std::move(description);
  out.update(of(key.value));
  return out;
}

Json of_keys(const Table& table) {
  Json properties = Json::object();
  Json required = Json::array();
  for (const Key& key : table.keys) {
    properties[key.name] = of(key);
    if (key.required()) required.push_back(key.name);
  }
  Json out;
  if (!table.about.empty()) out["title"] = table.about;
  out["type"] = "object";
  out["properties"] = std::move(properties);
  if (!required.empty()) out["required"] = std::move(required);
  out["additionalProperties"] = false;
  return out;
}

}  // namespace

Json json_schema(const Table& table) {
  if (table.kinds.empty()) return of_keys(table);
  Json all = Json::array();
  for (Table kind : table.kinds) {
    kind.keys.insert(kind.keys.begin(), table.keys.begin(), table.keys.end());
    if (kind.about.empty()) kind.about = table.about;
    all.push_back(json_schema(kind));
  }
  return all.size() == 1 ? all.front() : Json{{"oneOf", all}};
}

}  // namespace lagroid::app
