#include "own_build.hpp"

#include <lagroid/run/files/kept_file.hpp>
#include <lagroid/run/machine.hpp>
#include <lagroid/run/process.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <initializer_list>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace lagroid::app {

namespace {

namespace fs = std::filesystem;

/// How programs against this library are compiled: a file that the build leaves beside its programs, and an
/// installation in its share/.
struct Recipe {
  std::string compiler;
  std::vector<std::string> flags;
  std::vector<std::string> preprocessing;
  std::vector<std::string> archives;   ///< of lagroid
  std::vector<std::string> libraries;  ///< of others
  std::vector<std::string> libraries_of_laws;
  std::vector<std::string> archives_of_derivatives;  ///< before those of lagroid

  std::vector<std::string> command(OwnPart part) const {
    std::vector<std::string> words{compiler};
    words.insert(words.end(), flags.begin(), flags.end());
    if (part == OwnPart::steps) words.emplace_back("-DLAGROID_STEPS_ALONE");
    // The laws are many instances, each run for a moment.
    if (part == OwnPart::laws) words.insert(words.end(), {"-DLAGROID_WITH_LAWS", "-O1"});
    if (part == OwnPart::derivatives)
      words.insert(words.end(), {"-DLAGROID_WITH_DERIVATIVES", "-DLAGROID_COMPACT", "-O1"});
    return words;
  }
};

Recipe recipe(OwnPart part) {
  const fs::path prefix = fs::canonical("/proc/self/exe").parent_path().parent_path();
  for (const char* name : {"own_program.json", "share/lagroid/own_program.json"}) {
    std::ifstream file(prefix / name);
    if (!file) continue;
    std::ostringstream text;
    text << file.rdbuf();
    std::string content = text.str();
    const std::string mark = "{prefix}";
    for (auto at = content.find(mark); at != std::string::npos; at = content.find(mark, at))
      content.replace(at, mark.size(), prefix.string());
    const auto json = nlohmann::json::parse(content);
    Recipe out;
    json.at("compiler").get_to(out.compiler);
    json.at("flags").get_to(out.flags);
    json.at("preprocessing").get_to(out.preprocessing);
    json.at("archives").get_to(out.archives);
    json.at("libraries").get_to(out.libraries);
    json.at("libraries of laws").get_to(out.libraries_of_laws);
    json.at("archives of derivatives").get_to(out.archives_of_derivatives);
    std::erase_if(out.flags, [](const std::string& flag) { return flag.empty() || flag == "-I" || flag == "-D"; });
    if (part == OwnPart::derivatives)
      out.archives.insert(out.archives.begin(), out.archives_of_derivatives.begin(), out.archives_of_derivatives.end());
    for (const std::string& archive : out.archives)
      if (!fs::exists(archive))
        throw BuildRefused(
            fmt::format("{} is not there: a program of your own needs the library; install the package "
                        "liblagroid-dev, or build the targets lagroid_own and lagroid_derivatives",
                        archive));
    return out;
  }
  throw BuildRefused(fmt::format(
      "no own_program.json below {}: a program of your own needs the library; install the package liblagroid-dev",
      prefix.string()));
}

/// The user's cache; refused where somebody else could put a program there.
fs::path cache_folder() {
  const auto from = [](const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? std::string() : std::string(value);
  };
  fs::path base = from("XDG_CACHE_HOME");
  if (!base.is_absolute()) base = from("HOME").empty() ? fs::path() : fs::path(from("HOME")) / ".cache";
  if (!base.is_absolute()) throw BuildRefused("no folder for what is compiled: set HOME or XDG_CACHE_HOME");
  std::error_code failed;
  fs::create_directories(base, failed);
  const fs::path folder = base / "lagroid";
  if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST)
    throw BuildRefused(fmt::format("{}: {}; set XDG_CACHE_HOME to a folder that can be written in", folder.string(),
                                   std::generic_category().message(errno)));
  struct stat found {};
  const bool there = ::lstat(folder.c_str(), &found) == 0;
  if (!there || !S_ISDIR(found.st_mode) || found.st_uid != ::geteuid() || (found.st_mode & 0077) != 0)
    throw BuildRefused(
        fmt::format("{}: must be a folder of yours that nobody else may enter, for programs are run from it; "
                    "chmod 700 it, or remove it",
                    folder.string()));
  return folder;
}

/// A folder inside the cache that ends with this.
class Scratch {
 public:
  explicit Scratch(const fs::path& cache) {
    std::string name = (cache / "build-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw BuildRefused(fmt::format("{}: {}", name, std::generic_category().message(errno)));
    path = name;
  }
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  fs::path path;
};

/// The sentence of a requirement that failed, as g++ or clang tells it; empty in another line.
std::string requirement_in(const std::string& line) {
  for (const std::string_view failed : {"static assertion failed", "static_assert failed"})
    if (const std::size_t at = line.find(failed); at != std::string::npos) {
      const std::string told = line.substr(at + failed.size());  // `: words`, or `due to requirement 'x' "words"`
      const std::size_t quoted = told.find('"');
      if (quoted != std::string::npos) return told.substr(quoted + 1, told.rfind('"') - quoted - 1);
      return told.substr(std::min(told.size(), told.find(": ") + 2));
    }
  return "";
}

/// What the compiler says, from its first error in the user's file on, or from the first line that names the file;
/// after the sentence of a requirement that failed.
std::string from_the_users_line(const std::string& said, const fs::path& source) {
  std::vector<std::string> lines;
  std::istringstream text(said);
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  const std::string file = source.filename().string();
  const auto with = [&](std::initializer_list<std::string_view> words) {
    return std::ranges::find_if(lines, [&](const std::string& line) {
      return std::ranges::all_of(words, [&](std::string_view word) { return line.find(word) != std::string::npos; });
    });
  };
  const auto failed =
      std::ranges::find_if(lines, [](const std::string& line) { return !requirement_in(line).empty(); });
  auto from = failed == lines.end() ? with({file, "error:"}) : lines.end();
  if (from == lines.end()) from = with({file});
  if (from == lines.end()) from = lines.begin();
  constexpr std::size_t enough = 6000;
  std::string out = failed == lines.end() ? "" : requirement_in(*failed) + "\n";
  for (; from != lines.end() && out.size() < enough; ++from) out += *from + "\n";
  return from == lines.end() ? out : out + "(and more)\n";
}

/// Runs a command of the compiler's.
void compile(const std::vector<std::string>& words, const fs::path& out, const fs::path& log, const fs::path& source) {
  int code = 0;
  try {
    code = run_process(words, {.out = out, .error = log});
  } catch (const std::system_error& error) {
    throw BuildRefused(fmt::format("{}; install the package g++", error.what()));
  }
  if (code != 0)
    throw BuildRefused(fmt::format(
        "{} does not compile\n{}", source.string(),
        from_the_users_line(contents(log).value_or(fmt::format("{} ended with {}", words[0], code)), source)));
}

}  // namespace

fs::path built_from(const fs::path& source, OwnPart part, const std::function<void()>& told) {
  const Recipe how = recipe(part);
  const fs::path cache = cache_folder();
  const Scratch scratch(cache);
  std::vector<std::string> words = how.command(part);
  const std::string file = fs::absolute(source).lexically_normal().string();
  const fs::path log = scratch.path / "log";

  std::vector<std::string> preprocess = words;
  preprocess.insert(preprocess.end(), how.preprocessing.begin(), how.preprocessing.end());
  preprocess.push_back(file);
  const fs::path text = scratch.path / "text";
  compile(preprocess, text, log, source);
  std::string key = contents(text).value_or("");
  key += fmt::format("\n{}\n{}\n{}", fmt::join(words, "\n"), fmt::join(how.libraries, "\n"), program());
  for (const std::string& archive : how.archives)
    key += fmt::format("\n{} {}", fs::file_size(archive), fs::last_write_time(archive).time_since_epoch().count());
  // Programs of the same name as the source: a program and its laws find each other by it.
  const fs::path folder = cache / fmt::format("{:016x}{:08x}", sum_of(key), key.size());
  fs::path program = folder / source.stem();
  std::error_code failed;
  if (fs::exists(program, failed)) return program;

  told();
  words.insert(words.end(), {file, "-o", (scratch.path / "program").string()});
  words.insert(words.end(), how.archives.begin(), how.archives.end());
  words.insert(words.end(), how.libraries.begin(), how.libraries.end());
  if (part == OwnPart::laws) words.insert(words.end(), how.libraries_of_laws.begin(), how.libraries_of_laws.end());
  compile(words, {}, log, source);
  ::mkdir(folder.c_str(), 0700);
  fs::rename(scratch.path / "program", program, failed);
  if (failed) throw BuildRefused(fmt::format("{}: {}", program.string(), failed.message()));
  return program;
}

}  // namespace lagroid::app
