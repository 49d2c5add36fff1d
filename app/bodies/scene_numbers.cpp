#include "scene_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace lagroid::app {

namespace {

/// Where a body is and how it moves is its state, from the start on.
bool is_parameter(std::string_view kind, std::string_view key) {
  return kind != "body" || key == "mass" || key == "inertia";
}

}  // namespace

std::vector<SceneNumber> numbers_of_scene(const Section& scene) {
  std::vector<SceneNumber> out;
  const Section copy = scene.with(std::vector<Change>{});  // what is read of it here counts as read by nobody
  for (const char* kind : {"body", "joint", "effect"}) {
    const std::vector<Section> tables = copy.tables(kind);
    for (std::size_t i = 0; i < tables.size(); ++i) {
      if (!tables[i].has("name")) continue;
      const std::string name = tables[i].text("name", "its name");
      for (const std::string& leaf : tables[i].as_overrides()) {
        const std::string key = leaf.substr(0, leaf.find('='));
        if (!is_parameter(kind, key)) continue;
        const std::string path = fmt::format("{}.{}.{}", kind, i, key);
        const std::vector<double> values = copy.numbers_at(path);
        if (tables[i].is_number(key)) {
          out.push_back({name + "." + key, path, values.front()});
          continue;
        }
        for (std::size_t k = 0; k < values.size(); ++k)
          out.push_back({fmt::format("{}.{}.{}", name, key, k), fmt::format("{}.{}", path, k), values[k]});
      }
    }
  }
  return out;
}

Section scene_with(const Section& scene, const std::vector<SceneNumber>& numbers) {
  std::vector<Change> changes;
  for (const SceneNumber& number : numbers) changes.push_back({number.path, {number.value}});
  return scene.with(changes);
}

}  // namespace lagroid::app
