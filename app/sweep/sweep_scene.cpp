#include "sweep_scene.hpp"

#include "../families/family.hpp"
#include "../reading/its_scene.hpp"

#include <lagroid/run/machine.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace lagroid::app {

namespace {

namespace fs = std::filesystem;

/// So many that threads and ranks are kept busy to the end, so few that a folder holds them easily.
constexpr long most_parts = 512;  ///< unless more are asked for
constexpr long most_files = 1'000'000;

SweepPlot read_plot(const Section& sweep) {
  const Section section = sweep.section_or_empty("plot");
  SweepPlot plot;
  const auto read = [&](const char* key, std::string& to) {
    if (section.has(key)) to = section.text(key, "a column of members.csv");
  };
  read("x", plot.x);
  read("y", plot.y);
  read("quantity", plot.quantity);
  if (!plot.y.empty() && plot.x.empty()) section.fail("y", "goes with x");
  return plot;
}

/// All but scene and design.
void read_rest(const Section& sweep, SweepScene& out) {
  out.keep = read_keep(sweep);
  out.plot = read_plot(sweep);
  const Section run = sweep.section_or_empty("run");
  out.engine = run.choice_or("engine", "auto", {"auto", "scenes", "lanes"});
  const long count = out.design.count();
  out.part = run.integer_or("part", (count + most_parts - 1) / most_parts, 1, 100'000'000);
  if (out.parts() > most_files)
    run.fail("part", fmt::format("makes {} parts, each a file for a while; take {} or more", out.parts(),
                                 (count + most_files - 1) / most_files));
}

}  // namespace

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
