#include "sweep_scene.hpp"

#include "../families/family.hpp"
#include "../reading/its_scene.hpp"
#include "../reading/kinds.hpp"

#include <lagroid/run/machine.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>

namespace lagroid::app {

namespace {

namespace fs = std::filesystem;

/// So many that threads and ranks are kept busy to the end, so few that a folder holds them easily.
constexpr long most_parts = 512;  ///< unless more are asked for
constexpr long most_files = 1'000'000;

KeyOf<Text> column_key(std::string name, std::string meaning) {
  return {std::move(name), {}, "", "a column of members.csv: " + std::move(meaning), {}, "it is not drawn"};
}
const KeyOf<Text> x_key = column_key("x", "to the right");
const KeyOf<Text> y_key = column_key("y", "upwards");
const KeyOf<Text> quantity_key = column_key("quantity", "what is shown");
const KeyOf<OneOf> engine_key{"engine", {{"auto", "scenes", "lanes"}}, "", "how members are run", "auto"};
const KeyOf<Whole> part_key{"part", {1, 100'000'000},   "", "members of a part, which is computed as a whole",
                            {},     "at most 512 parts"};
const KeyOf<Either> scene_key{std::string(keys::sweep),
                              {{{Text{}}, {AnyTable{}}}},
                              "",
                              "the path of a scene, or the scene itself, or `file` and what differs from it"};

SweepPlot read_plot(const Section& sweep) {
  const Section section = sweep.section_or_empty("plot");
  SweepPlot plot;
  plot.x = read_key_or(section, x_key, "");
  plot.y = read_key_or(section, y_key, "");
  plot.quantity = read_key_or(section, quantity_key, "");
  if (!plot.y.empty() && plot.x.empty()) section.fail("y", "goes with x");
  return plot;
}

/// All but scene and design.
void read_rest(const Section& sweep, SweepScene& out) {
  out.keep = read_keep(sweep);
  out.plot = read_plot(sweep);
  const Section run = sweep.section_or_empty("run");
  out.engine = read_key(run, engine_key);
  const long count = out.design.count();
  out.part = read_key_or(run, part_key, (count + most_parts - 1) / most_parts);
  if (out.parts() > most_files)
    run.fail("part", fmt::format("makes {} parts, each a file for a while; take {} or more", out.parts(),
                                 (count + most_files - 1) / most_files));
}

}  // namespace

Table sweep_table() {
  return {{scene_key, optional_table("keep", keep_table(), "what is kept of every member"),
           optional_table("plot", {{x_key, y_key, quantity_key}}, "what is drawn"),
           optional_table("run", {{engine_key, part_key}}, "how it is computed")},
          design_tables(),
          "many members of a scene"};
}

SweepScene read_sweep(const fs::path& file, const std::vector<std::string>& overrides) {
  const Section sweep = read_scene(file, overrides);
  require_command(sweep, "sweep");
  SweepScene out;
  out.file = file.string();
  out.text = sweep.whole();
  if (!sweep.has("scene")) sweep.fail("", "missing key \"scene\": give the path of a scene, or the table [scene]");
  out.scene = read_its_scene(sweep);
  out.given = out.scene.whole();
  out.design = read_design(sweep, out.scene);
  read_rest(sweep, out);
  sweep.finish();
  return out;
}

std::string packed(const SweepScene& sweep) {
  nlohmann::json keys = nlohmann::json::array();
  for (const Design::Key& key : sweep.design.keys) keys.push_back({key.path, key.columns});
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(sweep.design.values.data());
  const std::vector<std::uint8_t> cbor = nlohmann::json::to_cbor(
      {{"program", program()},
       {"file", sweep.file},
       {"text", sweep.text},
       {"scene file", sweep.scene.file()},
       {"scene", sweep.scene.whole()},
       {"keys", keys},
       {"values", nlohmann::json::binary({bytes, bytes + sweep.design.values.size() * sizeof(double)})}});
  return {cbor.begin(), cbor.end()};
}

SweepScene unpacked(const std::string& text, bool other_build) {
  const auto json = nlohmann::json::from_cbor(text);
  if (const std::string leader = json.at("program"); leader != program() && !other_build)
    throw RunError(fmt::format("is another build of lagroid, or on another kind of processor, than rank 0 ({}, not {})",
                               program(), leader));
  SweepScene out;
  out.file = json.at("file");
  out.text = json.at("text");
  out.scene = parse_scene(json.at("scene").get<std::string>(), json.at("scene file"), {});
  for (const auto& key : json.at("keys")) out.design.keys.push_back({key.at(0), key.at(1)});
  const auto& bytes = json.at("values").get_binary();
  out.design.values.resize(bytes.size() / sizeof(double));
  std::memcpy(out.design.values.data(), bytes.data(), bytes.size());
  read_rest(parse_scene(out.text, out.file, {}), out);
  return out;
}

OutputSource source_of(const SweepScene& sweep) {
  const auto& values = sweep.design.values;
  return {{"sweep", sweep.text},
          {"scene", sweep.given},
          {"members", {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)}}};
}

}  // namespace lagroid::app
