#include "scene_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <variant>

namespace lagroid::app {

namespace {

/// Where a body is and how it moves is its state, from the start on.
bool is_parameter(std::string_view kind, std::string_view key) {
  return kind != "body" || key == "mass" || key == "inertia";
}
/// What a body is made of, beside its state.
bool is_differentiated(std::string_view kind, std::string_view key) {
  return is_parameter(kind, key) || key == "length" || key == "centre" || key == "pivot" ||
         key.starts_with("ground_") || (kind == "body" && key == "at");
}

/// Its own, or that of where it stands.
std::string name_of(const Section& table, const std::string& place) {
  return table.has("name") ? table.text("name", "its name") : place;
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
      const std::string name = name_of(tables[i], place);
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

/// What holds where the key is not given; empty where that is no number.
std::vector<double> numbers_that_hold(const Key& key) {
  if (const auto* number = std::get_if<double>(&key.fallback)) return {*number};
  if (const auto* array = std::get_if<std::vector<double>>(&key.fallback)) return *array;
  return {};
}

}  // namespace

std::vector<SceneNumber> numbers_of_scene(const Section& scene) { return listed_numbers(scene, is_parameter, false); }

std::vector<SceneNumber> numbers_to_differentiate(const Section& scene) {
  return listed_numbers(scene, is_differentiated, true);
}

std::vector<SceneNumber> places_of_joints(const Section& scene, const SceneBodies& bodies) {
  std::vector<SceneNumber> out;
  const Section copy = scene.with(std::vector<Change>{});
  const std::vector<Section> joints = copy.tables("joint");
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (!joints[i].has("points")) continue;
    const std::string path = fmt::format("joint.{}", i);
    const std::string name = name_of(joints[i], path);
    const std::vector<std::string> tied = joints[i].texts_or_none("between", "two bodies");
    std::array<Eigen::Matrix3d, 2> attitude{Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity()};
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    bool can_move = true, planar = false;  // a point mass has no other points
    for (std::size_t end = 0; end < 2; ++end) {
      const std::vector<double> arm = copy.numbers_at(fmt::format("{}.points.{}", path, end));
      Eigen::Vector3d at(arm[0], arm[1], arm[2]);
      if (tied[end] != "ground") {
        const NamedBody& body = bodies.named(joints[i], "between", tied[end]);
        can_move = can_move && (body.planar || body.body.attitude.index >= 0);
        planar = planar || body.planar;
        attitude[end] = body.attitude;
        at = body.place + body.attitude * at;
      }
      if (end == 0) place = at;
    }
    for (int k = 0; can_move && k < (planar ? 2 : 3); ++k) {
      SceneNumber number{fmt::format("{}.place.{}", name, k), "", place(k), place(k)};
      for (std::size_t end = 0; end < 2; ++end)
        for (int m = 0; m < 3; ++m)
          if (const double rate = attitude[end](k, m); rate != 0) {
            const std::string entry = fmt::format("{}.points.{}.{}", path, end, m);
            number.shared.push_back({entry, copy.numbers_at(entry).front(), rate});
          }
      out.push_back(std::move(number));
    }
  }
  return out;
}

Section with_constants(const Section& scene) {
  std::vector<std::string> overrides;
  const Section copy = scene.with(std::vector<Change>{});
  const auto write = [&](const std::string& kind, const std::vector<SceneKind>& kinds, const auto& is_wanted) {
    const std::vector<Section> tables = copy.tables(kind);
    for (std::size_t i = 0; i < tables.size(); ++i) {
      const std::string name = tables[i].text("kind", "its kind");
      const auto of = std::find_if(kinds.begin(), kinds.end(), [&](const SceneKind& k) { return k.name == name; });
      for (const Key& key : of->keys) {
        const std::vector<double> holds = numbers_that_hold(key);
        if (tables[i].has(key.name) || holds.empty() || !is_wanted(key.name, holds)) continue;
        const bool alone = std::holds_alternative<double>(key.fallback);
        overrides.push_back(fmt::format("{}.{}.{}={}{}{}", kind, i, key.name, alone ? "" : "[", fmt::join(holds, ", "),
                                        alone ? "" : "]"));
      }
    }
  };
  write("body", body_kinds(), [](std::string_view key, const std::vector<double>&) { return key == "pivot"; });
  write("effect", effect_kinds(), [](std::string_view, const std::vector<double>& holds) {
    return std::any_of(holds.begin(), holds.end(), [](double x) { return x != 0; });
  });
  return overrides.empty() ? scene : scene.set(overrides);
}

std::vector<VariedAt> SceneNumber::varied(const VariedNumber& number) const {
  if (shared.empty()) return {{path, number}};
  std::vector<VariedAt> out;
  for (const SharedChange& each : shared) out.push_back({each.path, number * each.rate});
  return out;
}

Section scene_with(const Section& scene, const std::vector<SceneNumber>& numbers) {
  std::map<std::string, double> values;
  for (const SceneNumber& number : numbers)
    if (number.shared.empty()) values[number.path] = number.value;
  for (const SceneNumber& number : numbers)
    for (const SharedChange& each : number.shared)
      values.try_emplace(each.path, each.value).first->second += each.rate * (number.value - number.given);
  std::vector<Change> changes;
  for (const auto& [path, value] : values) changes.push_back({path, {value}});
  return scene.with(changes);
}

}  // namespace lagroid::app
