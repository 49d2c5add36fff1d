#include "command.hpp"

#include "output_folder.hpp"
#include "report.hpp"
#include "scene_reader.hpp"

#include <fmt/format.h>
#include <glog/logging.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <sstream>
#include <string_view>
#include <system_error>

namespace lagroid::app {

namespace {

/// Where one of them was closed, a file of ours would be opened as it, and be written into by whoever prints.
void hold_standard_descriptors() {
  for (int opened = ::open("/dev/null", O_RDWR); opened >= 0; opened = ::open("/dev/null", O_RDWR))
    if (opened > STDERR_FILENO) {
      ::close(opened);
      return;
    }
}

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
  } catch (const FolderRefused& error) {
    return refuse(asks_for_json(argc, argv), exit_bad_input, "invalid_command_line", error.what());
  } catch (const OutputError&) {
    throw;
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::resource_unavailable_try_again) throw;
    return refuse(options.json, exit_failed, "no_threads",
                  "no thread could be started (raise ulimit -u, or lower ulimit -s; --threads asks for fewer)");
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
  hold_standard_descriptors();
  // What Ceres would say on standard error stands in its summary too, and is judged anew from the residual.
  FLAGS_minloglevel = google::GLOG_FATAL;
  try {
    return parse_and_serve(app, argc, argv, options, serve);
  } catch (const OutputError& error) {
    fmt::print(stderr, "lagroid: {}\n", error.what());
    return exit_failed;
  }
}

}  // namespace lagroid::app
