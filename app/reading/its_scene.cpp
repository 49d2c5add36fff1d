#include "its_scene.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

namespace lagroid::app {

namespace {

namespace fs = std::filesystem;

fs::path scene_file(const Section& at, const char* key, const std::string& from) {
  const std::string name = at.text(key, "the path of a scene");
  const fs::path beside = fs::path(from).parent_path() / name;
  std::error_code ignored;
  if (fs::is_regular_file(beside, ignored)) return beside;
  if (!fs::is_regular_file(name, ignored))
    at.fail(key, fmt::format("no such scene file: there is no \"{}\" beside {} or here", name, from));
  return name;
}

}  // namespace

Section read_its_scene(const Section& whole) {
  if (!whole.is_table("scene")) return read_scene(scene_file(whole, "scene", whole.file()), {});
  const Section section = whole.section("scene", "the scene");
  std::vector<std::string> overrides = section.as_overrides();
  try {
    const std::string overrider = whole.file() + ": scene.";
    if (!section.has("file")) return parse_scene("", whole.file(), overrides, overrider);
    std::erase_if(overrides, [](const std::string& each) { return each.starts_with("file="); });
    return read_scene(scene_file(section, "file", whole.file()), overrides, overrider);
  } catch (const SceneError& error) {
    section.fail("", error.problem());
  }
}

}  // namespace lagroid::app
