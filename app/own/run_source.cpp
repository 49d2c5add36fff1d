#include "run_source.hpp"

#include "../command/command.hpp"
#include "own_build.hpp"
#include "own_parts.hpp"

#include <lagroid/run/process.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace lagroid::app {

namespace {

namespace fs = std::filesystem;

/// The words that the program is to be run with.
std::vector<std::string> words_for(const fs::path& source, std::vector<std::string> given) {
  if (!given.empty() && given[0].ends_with(".toml")) {
    given.insert(given.begin(), "run");
  } else if (given.empty() || given[0].starts_with("-")) {
    fs::path scene = source;
    scene.replace_extension(".toml");
    std::error_code ignored;
    if (fs::exists(scene, ignored)) given.insert(given.begin(), {"run", scene.string()});
  }
  return given;
}

/// Becomes the program.
[[noreturn]] void become(const fs::path& program, const std::vector<std::string>& words) {
  std::vector<std::string> kept{program.string()};
  kept.insert(kept.end(), words.begin(), words.end());
  std::vector<char*> arguments;
  for (std::string& word : kept) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execv(program.c_str(), arguments.data());
  throw std::system_error(errno, std::generic_category(), program.string());
}

fs::path built(const fs::path& source, OwnPart part) {
  const std::array what{"", " with all methods", " with its laws", " with derivatives of its runs"};
  return built_from(source, part,
                    [&] { complain(fmt::format("compiling {}{}", source.string(), what[std::size_t(part)])); });
}

int carry_out(const fs::path& source, const std::vector<std::string>& words) {
  const std::string command = words.empty() ? "" : words[0];
  const auto is = [&](const char* name) { return command == name; };
  if (is("check")) become(built(source, OwnPart::laws), {words.begin() + 1, words.end()});
  for (const std::string& word : words)
    if (is("run") && (word.starts_with("--covariance") || word.starts_with("--deviations")))
      return refuse(false, exit_bad_input, "invalid_command_line",
                    fmt::format("{}: of a source, lagroid run {} gradient SCENE {} has what errors become", word,
                                source.string(), word));
  if (is("gradient")) become(built(source, OwnPart::derivatives), {words.begin() + 1, words.end()});
  if (is("fit")) become(built(source, OwnPart::derivatives), words);
  if (is("study") || is("sweep")) become(built(source, OwnPart::methods), words);
  const fs::path steps = built(source, OwnPart::steps);
  std::string asked = (fs::temp_directory_path() / "lagroid-XXXXXX").string();
  const int file = ::mkstemp(asked.data());
  if (file < 0) become(built(source, OwnPart::methods), words);
  ::close(file);
  ::setenv(where_to_ask, asked.c_str(), 1);
  std::vector<std::string> all{steps.string()};
  all.insert(all.end(), words.begin(), words.end());
  const int code = run_process(all);
  std::error_code ignored;
  const bool asks = fs::file_size(asked, ignored) > 0;
  fs::remove(asked, ignored);
  ::unsetenv(where_to_ask);
  if (asks) become(built(source, OwnPart::methods), words);
  return code;
}

}  // namespace

bool names_a_source(int argc, char** argv) {
  if (argc < 3 || std::string_view(argv[1]) != "run") return false;
  const std::string extension = fs::path(argv[2]).extension().string();
  return extension == ".cpp" || extension == ".cc" || extension == ".cxx";
}

int run_source(int argc, char** argv) {
  const fs::path source = argv[2];
  std::error_code ignored;
  if (!fs::is_regular_file(source, ignored))
    return refuse(false, exit_bad_input, "invalid_command_line", fmt::format("{}: no such file", source.string()));
  try {
    return carry_out(source, words_for(source, {argv + 3, argv + argc}));
  } catch (const BuildRefused& error) {
    // Lines of the compiler's, as they are.
    const std::string message = error.what();
    const auto end = message.find('\n');
    complain(message.substr(0, end));
    if (end != std::string::npos) fmt::print(stderr, "{}", message.substr(end + 1));
    return exit_bad_input;
  } catch (const std::exception& error) {
    return refuse(false, exit_internal_error, "internal_error", error.what());
  }
}

}  // namespace lagroid::app
