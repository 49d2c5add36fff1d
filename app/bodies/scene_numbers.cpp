#include "scene_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace lagroid::app {

namespace {

/// Where a body is and how it moves is its state, from the start on.
bool is_parameter(std::string_view kind, std::string_view key) {
  return kind != "body" || key == "mass" || key == "inertia";
}
/// What a body is made of, beside its state.
bool is_differentiated(std::string_view kind, std::string_view key) {
  return is_parameter(kind, key) || key == "length" || key == "centre" || key.starts_with("ground_");
}

/// The numbers at keys that are wanted, of tables with a name; or, of the whole scene, of all, and points too.
template <class Wanted>
std::vector<SceneNumber> listed_numbers(const Section& scene, const Wanted& is_wanted, bool whole) {
  std::vector<SceneNumber> out;
  const Section copy = scene.with(std::vector<Change>{});  // what is read of it here counts as read by nobody
  const auto add = [&](const std::string& name, const std::string& path, bool alone) {
    const std::vector<double> values = copy.numbers_at(path);
    for (std::size_t k = 0; k < values.size(); ++k)
      out.push_back(alone ? SceneNumber{name, path, values[k]}
                          : SceneNumber{fmt::format("{}.{}", name, k), fmt::format("{}.{}", path, k), values[k]});
  };
  for (const char* kind : {"body", "joint", "effect"}) {
    const std::vector<Section> tables = copy.tables(kind);
    for (std::size_t i = 0; i < tables.size(); ++i) {
      const std::string place = fmt::format("{}.{}", kind, i);
      if (!whole && !tables[i].has("name")) continue;
      const std::string name = tables[i].has("name") ? tables[i].text("name", "its name") : place;
      for (const std::string& leaf : tables[i].as_overrides()) {
        const std::string key = leaf.substr(0, leaf.find('='));
        if (!is_wanted(kind, key)) continue;
        add(name + "." + key, place + "." + key, tables[i].is_number(key));
        if (whole && key == "points")
          for (int end = 0; end < 2; ++end)
            add(fmt::format("{}.{}.{}", name, key, end), fmt::format("{}.{}.{}", place, key, end), false);
      }
    }
  }
  return out;
}

}  // namespace

std::vector<SceneNumber> numbers_of_scene(const Section& scene) { return listed_numbers(scene, is_parameter, false); }

std::vector<SceneNumber> numbers_to_differentiate(const Section& scene) {
  return listed_numbers(scene, is_differentiated, true);
}

Section scene_with(const Section& scene, const std::vector<SceneNumber>& numbers) {
  std::vector<Change> changes;
  for (const SceneNumber& number : numbers) changes.push_back({number.path, {number.value}});
  return scene.with(changes);
}

}  // namespace lagroid::app
