#include "json_schema.hpp"

#include "bounds.hpp"

#include <fmt/format.h>

#include <utility>

namespace lagroid::app {

namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson of(const Value& value);

OrderedJson array_of(const OrderedJson& items, std::size_t least) {
  return {{"type", "array"}, {"items", items}, {"minItems", least}};
}
OrderedJson array_of(const OrderedJson& items, std::size_t least, std::size_t most) {
  OrderedJson out = array_of(items, least);
  out["maxItems"] = most;
  return out;
}

OrderedJson of(const Number& number) {
  OrderedJson out{{"type", "number"}};
  const Bounds bounds = bounds_of(number.rule);
  if (bounds.least) out[bounds.least->excluded ? "exclusiveMinimum" : "minimum"] = bounds.least->value;
  if (bounds.most) out[bounds.most->excluded ? "exclusiveMaximum" : "maximum"] = bounds.most->value;
  return out;
}
OrderedJson of(const Whole& whole) { return {{"type", "integer"}, {"minimum", whole.least}, {"maximum", whole.most}}; }
OrderedJson of(const OneOf& choice) {
  if (choice.words.size() == 1) return {{"const", choice.words.front()}};
  return {{"enum", choice.words}};
}
OrderedJson of(const Text&) { return {{"type", "string"}}; }
OrderedJson of(const Texts&) { return array_of(of(Text()), 0); }
OrderedJson of(const Flag&) { return {{"type", "boolean"}}; }
OrderedJson of(const NumberArray& numbers) { return array_of(of(Number{numbers.rule}), numbers.size, numbers.size); }
OrderedJson of(const NumberList& numbers) { return array_of(of(Number{numbers.rule}), 1); }
OrderedJson of(const AnyAttitude&) { return array_of(of(Number()), 3, 4); }
OrderedJson of(const SpacePoints& points) {
  const OrderedJson point = of(NumberArray{3});
  return points.count ? array_of(point, *points.count, *points.count) : array_of(point, 1);
}
OrderedJson of(const Table& table) { return json_schema(table); }
OrderedJson of(const Tables& tables) { return array_of(json_schema(tables.each), 0); }
OrderedJson of(const AnyTable&) { return {{"type", "object"}}; }
OrderedJson of(const Either& either) {
  OrderedJson any = OrderedJson::array();
  for (const Value& value : either.values) any.push_back(of(value));
  return {{"anyOf", any}};
}
OrderedJson of(const Value& value) {
  return std::visit([](const auto& is) { return of(is); }, value.is);
}

OrderedJson of(const Key& key) {
  OrderedJson out = OrderedJson::object();
  std::string description = key.unit.empty() ? key.meaning : fmt::format("{} [{}]", key.meaning, key.unit);
  if (!key.otherwise.empty()) {
    description += fmt::format(" (default: {})", key.otherwise);
  } else if (!key.required()) {
    out["default"] = std::visit(
        [](const auto& fallback) -> OrderedJson {
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

OrderedJson of_keys(const Table& table) {
  OrderedJson properties = OrderedJson::object();
  OrderedJson required = OrderedJson::array();
  for (const Key& key : table.keys) {
    properties[key.name] = of(key);
    if (key.required()) required.push_back(key.name);
  }
  OrderedJson out;
  if (!table.about.empty()) out["title"] = table.about;
  out["type"] = "object";
  out["properties"] = std::move(properties);
  if (!required.empty()) out["required"] = std::move(required);
  out["additionalProperties"] = false;
  return out;
}

}  // namespace

OrderedJson json_schema(const Table& table) {
  if (table.kinds.empty()) return of_keys(table);
  OrderedJson all = OrderedJson::array();
  for (Table kind : table.kinds) {
    kind.keys.insert(kind.keys.begin(), table.keys.begin(), table.keys.end());
    if (kind.about.empty()) kind.about = table.about;
    all.push_back(json_schema(kind));
  }
  return all.size() == 1 ? all.front() : OrderedJson{{"oneOf", all}};
}

}  // namespace lagroid::app
