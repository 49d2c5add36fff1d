#include "command.hpp"

#include "output.hpp"
#include "report.hpp"
#include "scene_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <sstream>
#include <string_view>

namespace lagroid::app {

namespace {

int parse_and_serve(CLI::App& app, int argc, char** argv, SceneOptions& options, const std::function<int()>& serve) {
  try {
    app.parse(argc, argv);
    return serve();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      std::ostringstream text;
      app.exit(error, text, text);
      print(text.str());
      return 0;
    }
    // The flag may not have been read before the mistake was met.
    options.json = asks_for_json(argc, argv);
    return refuse(options.json, exit_bad_input, "invalid_command_line",
                  fmt::format("{}; see {} --help", error.what(), app.get_name()));
  } catch (const SceneError& error) {
    return refuse(options.json, exit_bad_input, "invalid_scene", error.what());
  } catch (const OutputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    return refuse(options.json, exit_failed, "out_of_memory",
                  fmt::format("{}: out of memory; lower time.steps, or raise output.every", options.scene));
  } catch (const std::exception& error) {
    return refuse(options.json, exit_internal_error, "internal_error",
                  fmt::format("internal error: {}; please report it with the scene", error.what()));
  }
}

}  // namespace

void add_scene_options(CLI::App& command, SceneOptions& options) {
  command.add_option("scene", options.scene, "the scene, a TOML file")->required();
  command.add_option("--set", options.overrides, "override a key: --set time.steps=100 (repeatable)")
      ->allow_extra_args(false);
  command.add_flag("--json", options.json, "print one JSON object and nothing else on standard output");
}

bool asks_for_json(int argc, char** argv) {
  return std::any_of(argv + 1, argv + argc, [](const char* word) { return std::string_view(word) == "--json"; });
}

void print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw OutputError("standard output could not be written");
}

int refuse(bool json, int code, const std::string& status, const std::string& message) {
  fmt::print(stderr, "lagroid: {}\n", message);
  if (json) print(json_error(status, message) + "\n");
  return code;
}

int command_line(CLI::App& app, int argc, char** argv, SceneOptions& options, const std::function<int()>& serve) {
  try {
    return parse_and_serve(app, argc, argv, options, serve);
  } catch (const OutputError& error) {
    fmt::print(stderr, "lagroid: {}\n", error.what());
    return exit_failed;
  }
}

}  // namespace lagroid::app
