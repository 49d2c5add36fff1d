#pragma once
/// A scene as Python holds it.

#include <reading/scene_reader.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lagroid::python {

/// A scene's text, or the file that holds it. It is read anew for each use, so that threads may share it.
struct Scene {
  std::optional<std::filesystem::path> file;
  std::string text;
  std::string name;
  std::vector<std::string> overrides;

  app::Section read() const {
    return file ? app::read_scene(*file, overrides) : app::parse_scene(text, name, overrides);
  }
};

}  // namespace lagroid::python
