#include "written.hpp"

#include "command.hpp"

#include <lagroid/run/interrupt.hpp>

#include <fmt/format.h>

namespace lagroid::app {

int code_after_writing(int code, const std::string& what) {
  if (code != 0 || !InterruptGuard::interrupted()) return code;
  complain(what + ": interrupted after the results were there");
  return exit_interrupted;
}

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
