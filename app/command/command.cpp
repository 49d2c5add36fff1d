#include "command.hpp"

#include "../reading/scene_reader.hpp"

#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/run/reports/report.hpp>
#include <lagroid/run/reports/text.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <sstream>
#include <string_view>
#include <system_error>

namespace lagroid::app {

namespace {

/// A pipe that nobody reads any more, and a file as large as is allowed, are errors of writing as a full disk is.
void take_failed_writes_for_errors() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

/// Of standard input, output and error what is closed is held by something that cannot be written to, so that no file
/// that is opened later takes its place and is told what is meant for a terminal.
void hold_standard_descriptors() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(descriptor, F_GETFD) < 0) ::open("/dev/null", O_RDONLY);  // takes the lowest that is free
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
  } catch (const std::bad_alloc&) {
    return refuse(options.json, exit_failed, "out_of_memory",
                  fmt::format("{}: out of memory; lower time.steps, or raise output.every", options.scene));
  } catch (const std::exception& error) {
    const auto* system = dynamic_cast<const std::system_error*>(&error);
    if (system != nullptr && system->code() == std::errc::resource_unavailable_try_again)
      return refuse(options.json, exit_failed, "no_threads",
                    "no thread could be started; raise ulimit -u, or lower ulimit -s");
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

CLI::Validator between(double low, double high) {
  const std::string range = fmt::format("between {:g} and {:g}", low, high);
  return {[=](std::string& given) {
            double x = 0;
            const bool number = CLI::detail::lexical_cast(given, x);
            return number && x >= low && x <= high ? std::string()
                                                   : fmt::format("give a number {}, not {}", range, given);
          },
          range};
}

bool asks_for_json(int argc, char** argv) {
  return std::any_of(argv + 1, argv + argc, [](const char* word) { return std::string_view(word) == "--json"; });
}

void print(const std::string& written) {
  const std::string text = visible(written, "\n");
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw OutputError("standard output could not be written");
}

void complain(const std::string& message) {
  std::fputs(fmt::format("lagroid: {}\n", visible(message)).c_str(), stderr);
}

int refuse(bool json, int code, const std::string& status, const std::string& message) {
  complain(message);
  if (json) print(json_error(status, message) + "\n");
  return code;
}

int command_line(CLI::App& app, int argc, char** argv, SceneOptions& options, const std::function<int()>& serve) {
  hold_standard_descriptors();
  take_failed_writes_for_errors();
  try {
    return parse_and_serve(app, argc, argv, options, serve);
  } catch (const OutputError& error) {
    complain(error.what());
    return exit_failed;
  }
}

}  // namespace lagroid::app
