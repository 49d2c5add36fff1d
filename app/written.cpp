#include "written.hpp"

#include <fmt/format.h>

namespace lagroid::app {

void tell_written(const std::vector<std::filesystem::path>& files, const std::string& note, std::string& text,
                  nlohmann::ordered_json& json) {
  for (const auto& file : files) {
    text += fmt::format("  wrote {}\n", file.string());
    json["files"].push_back(file.string());
  }
  if (note.empty()) return;
  text += fmt::format("  note: no pictures: {}\n", note);
  json["notes"].push_back("no pictures: " + note);
}

}  // namespace lagroid::app
