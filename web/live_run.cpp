#include "live_run.hpp"

#include <lagroid/run/events/event_function.hpp>
#include <lagroid/run/reports/report.hpp>

#include <families/family.hpp>
#include <reading/kinds.hpp>
#include <study/scene_experiment.hpp>

#include <algorithm>
#include <type_traits>
#include <utility>

namespace lagroid::web {

namespace {

using Json = nlohmann::ordered_json;
using app::Key;
using app::Section;
using app::Table;

/// The table of that name among the keys, or among those of one of the kinds; null where there is none.
const Table* table_of(const Table& keys, std::string_view name) {
  for (const Key& key : keys.keys)
    if (key.name == name)
      if (const auto* table = std::get_if<Table>(&key.value.is)) return table;
  for (const Table& kind : keys.kinds)
    if (const Table* table = table_of(kind, name)) return table;
  return nullptr;
}

/// The numbers and words of a table, and of those in it, with what the scene has there or what holds without.
void list(const Section& scene, const Section& here, const std::string& name, const Table& table, Json& out) {
  for (const Key& key : table.keys) {
    const std::string path = name + "." + key.name;
    if (const auto* inner = std::get_if<Table>(&key.value.is)) {
      list(scene, here.section_or_empty(key.name), path, *inner, out);
      continue;
    }
    // Four numbers of a rotation cannot be turned one by one.
    if (std::holds_alternative<app::AnyAttitude>(key.value.is)) continue;
    const bool is_one = std::holds_alternative<app::Number>(key.value.is);
    Json one{{"path", path}, {"unit", key.unit}, {"meaning", key.meaning}, {"is_list", !is_one}};
    if (const auto* words = std::get_if<app::OneOf>(&key.value.is)) {
      one["words"] = words->words;
      if (here.has(key.name)) one["value"] = here.choice(key.name, words->words);
    } else if (const auto given = scene.numbers_at(path); !given.empty()) {
      one["value"] = given;
    }
    if (!one.contains("value"))
      std::visit(
          [&](const auto& fallback) {
            using Fallback = std::decay_t<decltype(fallback)>;
            if constexpr (std::is_same_v<Fallback, double>)
              one["value"] = std::vector<double>{fallback};
            else if constexpr (std::is_same_v<Fallback, std::vector<double>> || std::is_same_v<Fallback, std::string>)
              one["value"] = fallback;
          },
          key.fallback);
    if (one.contains("value")) out.push_back(std::move(one));
  }
}

/// The numbers of a table whose names are the scene's own, but for those of rotations.
void list_own(const Section& scene, const Section& here, const std::string& name, const std::string& meaning,
              Json& out) {
  for (const std::string& override : here.as_overrides()) {
    const std::string path = name + "." + override.substr(0, override.find('='));
    const auto given = scene.numbers_at(path);
    if (given.empty() || path.ends_with("attitude")) continue;
    out.push_back(
        {{"path", path}, {"unit", ""}, {"meaning", meaning}, {"is_list", given.size() > 1}, {"value", given}});
  }
}

/// Of a scene of bodies: what it says of them, of what joins them and of what acts on them.
void list_bodies(const Section& scene, Json& out) {
  for (const char* kind : {"body", "joint", "effect"}) {
    const auto tables = scene.tables(kind);
    for (std::size_t i = 0; i < tables.size(); ++i) {
      const std::string name = tables[i].has("name") ? tables[i].text("name", "its name") : "";
      list_own(scene, tables[i], std::string(kind) + "." + std::to_string(i), name, out);
    }
  }
}

Json turned_by(const Section& scene) {
  Json out = Json::array();
  const app::SceneFamily& family = app::family_of(scene);
  if (family.key() != app::keys::system) {
    list_bodies(scene, out);
    return out;
  }
  const std::string name = scene.text(family.key(), "the name of a system");
  for (const app::SceneKeys& keys : family.keys_of_scenes())
    if (keys.name == name)
      for (const char* table : {"parameters", "initial", "boundary"}) {
        if (!scene.has(table) && table != std::string_view("parameters")) continue;
        const Section here = scene.section_or_empty(table);
        if (const Table* found = table_of(keys.table, table))
          list(scene, here, table, *found, out);
        else
          list_own(scene, here, table, "", out);
      }
  return out;
}

/// The first and the last row of each event: all that is told of the others is their number.
std::vector<Happening> ends_of(const EventTable& events) {
  std::vector<Happening> out;
  std::vector<const Happening*> last(events.watched.size());
  for (const Happening& row : events.rows) {
    if (row.passing == Passing::touching) continue;
    if (last[row.event] == nullptr) out.push_back(row);
    last[row.event] = &row;
  }
  for (const Happening* row : last)
    if (row != nullptr) out.push_back(*row);
  return out;
}

Section by_method(const Section& scene, const std::string& name) {
  const Section plain = app::without_method(scene);
  const auto methods = app::family_of(scene).read(plain, {}).methods;
  const auto found = std::find_if(methods.begin(), methods.end(), [&](const Method& m) { return m.name == name; });
  if (found == methods.end()) scene.fail("time", "cannot be integrated by \"" + name + "\"");
  return plain.set(found->settings);
}

}  // namespace

LiveRun::LiveRun(const std::string& text, const std::vector<std::string>& overrides, const std::string& method) {
  Section scene = app::parse_scene(text, "scene", overrides, "");
  if (!method.empty()) scene = by_method(scene, method);
  const app::SceneFamily& family = app::motions_of(scene);
  if (scene.has("boundary") || scene.section_or_empty("time").has("accuracy")) {
    result_ = family.run(scene, {.record = true});
  } else {
    scene_ = family.read(scene, {});
    followed_.emplace(*scene_.motion, scene_.extent, true, result_);
    followed_->begin();
  }
  turned_ = turned_by(scene);
  whole_ = scene.whole();
}

void LiveRun::advance(long steps) {
  if (!goes_on()) return;
  followed_->advance(steps);
  if (followed_->goes_on()) return;
  followed_->tell_end();
  followed_->finish();
  followed_.reset();
}

Json LiveRun::description() {
  Json columns = Json::array();
  for (const Columns& series : trajectory().series)
    columns.push_back({{"labels", series.components},
                       {"unit", series.unit},
                       {"meaning", series.meaning},
                       {"on_arrows", series.on_arrows}});
  Json methods = Json::array();
  for (const Method& method : scene_.methods)
    methods.push_back({{"name", method.name}, {"order", method.order}, {"to_compare", method.to_compare}});
  Json sections = Json::array();
  for (std::size_t i = 0; i < happened().watched.size(); ++i)
    if (const WatchedEvent& event = happened().watched[i]; !event.plot.empty())
      sections.push_back({{"event", i}, {"name", event.name}, {"x", event.plot[0]}, {"y", event.plot[1]}});
  Json out{{"columns", columns}, {"methods", methods}, {"turned", turned_}, {"whole", whole_}, {"sections", sections}};
  if (scene_.motion) out.update(Json{{"step", scene_.motion->step_size()}, {"steps", scene_.extent.steps}});
  if (scene_.motion && scene_.motion->why_not_cut().empty()) out["within"] = columns_within(scene_.motion->look());
  return out;
}

std::string LiveRun::summary() const {
  RunResult now = result_;
  now.events.rows = ends_of(result_.events);
  if (!followed_) return json_report(now);
  now.ledger = followed_->ledger();
  now.final = scene_.motion->look().endpoint();
  scene_.motion->describe(now);
  return json_report(now);
}

std::span<const double> LiveRun::values(std::size_t series) {
  const Trajectory& rows = trajectory();
  return series < rows.series.size() ? rows.series[series].values : rows.time;
}

std::span<const double> LiveRun::section(std::size_t event) {
  const EventTable& events = happened();
  section_.clear();
  if (event >= events.watched.size()) return section_;
  const auto value = [&](const Happening& row, const std::string& column) {
    const auto place = std::find(events.columns.begin(), events.columns.end(), column);
    return place == events.columns.end() ? row.time : row.values[std::size_t(place - events.columns.begin())];
  };
  const std::vector<std::string>& plot = events.watched[event].plot;
  for (auto row = events.rows.rbegin(); row != events.rows.rend() && section_.size() < 2 * most_points; ++row)
    if (row->event == event && row->passing != Passing::touching)
      section_.insert(section_.end(), {value(*row, plot[1]), value(*row, plot[0])});
  std::reverse(section_.begin(), section_.end());
  return section_;
}

}  // namespace lagroid::web
