#include "schema.hpp"

#include "../command/command.hpp"
#include "../families/family.hpp"
#include "json_schema.hpp"

#include <lagroid/core/version.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <vector>

namespace lagroid::app {

void add_schema_options(CLI::App& command, SchemaOptions& options) {
  command.add_option("kind", options.kind, "a system, or a kind of scenes that names none (default: all)");
}

int schema(const SchemaOptions& options) {
  Table scenes;
  std::vector<std::string> names;
  for (const SceneFamily* family : families())
    for (SceneKeys& each : family->keys_of_scenes()) {
      if (options.kind.empty() || options.kind == each.name) scenes.kinds.push_back(std::move(each.table));
      names.push_back(std::move(each.name));
    }
  if (scenes.kinds.empty())
    return refuse(false, exit_bad_input, "invalid_command_line",
                  fmt::format("schema: there are no scenes of \"{}\"; there are those of {}", options.kind,
                              fmt::join(names, ", ")));
  nlohmann::ordered_json out;
  out["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  out["title"] = fmt::format("Scenes of Lagroid {}", LAGROID_VERSION);
  out.update(json_schema(scenes));
  print(out.dump(1) + "\n");
  return 0;
}

}  // namespace lagroid::app
