#include "output_folder.hpp"

#include <fmt/format.h>

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <system_error>

namespace lagroid::app {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view staging_prefix = ".partial-";

/// Removes the stagings of runs that were killed: those of processes that are no more.
void remove_stale_stagings(const fs::path& folder) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(staging_prefix)) continue;
    pid_t owner = 0;
    const char* end = name.data() + name.size();
    const auto [rest, error] = std::from_chars(name.data() + staging_prefix.size(), end, owner);
    if (error == std::errc{} && rest == end && owner > 0 && kill(owner, 0) != 0 && errno == ESRCH)
      fs::remove_all(entry.path(), ignored);
  }
}

}  // namespace

void write_text(std::string_view text, const fs::path& file) {
  std::ofstream out(file, std::ios::binary);
  out.write(text.data(), std::streamsize(text.size()));
  out.close();
  if (!out) throw OutputError(fmt::format("{}: could not be written; is the disk full?", file.string()));
}

std::string run_gnuplot(const fs::path& folder, const std::string& script, const std::vector<std::string>& pictures) {
  const pid_t child = fork();
  if (child < 0) return "could not start a process";
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);  // killed with us
    if (chdir(folder.c_str()) != 0) _exit(126);
    if (std::freopen("plot.log", "w", stderr) == nullptr || std::freopen("/dev/null", "w", stdout) == nullptr)
      _exit(126);
    execlp("gnuplot", "gnuplot", script.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  int status = 0;
  waitpid(child, &status, 0);
  const bool drawn = std::all_of(pictures.begin(), pictures.end(),
                                 [&](const std::string& picture) { return fs::exists(folder / picture); });
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0 && drawn) return "";
  std::ifstream log(folder / "plot.log");
  std::string first;
  for (std::string line; std::getline(log, line);)
    if (line.find("line") != std::string::npos && first.empty()) first = line;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
    return fmt::format(
        "gnuplot is not installed (Debian package gnuplot-nox); run `gnuplot {}` in the output folder later", script);
  return fmt::format("gnuplot failed{}", first.empty() ? "" : ": " + first);
}

void require_writable(const fs::path& folder, std::span<const char* const> files) {
  if (folder.empty()) throw OutputError("--out: the folder's name is empty; give one, as in --out out/run");
  std::error_code error;
  fs::path existing = fs::absolute(folder);
  while (!fs::exists(existing, error) && existing.has_parent_path() && existing != existing.parent_path())
    existing = existing.parent_path();
  if (fs::is_symlink(folder, error) && !fs::exists(folder, error))
    throw OutputError(fmt::format("--out {}: a link to nothing; choose another place", folder.string()));
  if (!fs::is_directory(existing, error))
    throw OutputError(
        fmt::format("--out {}: {} is not a folder; choose another place", folder.string(), existing.string()));
  // Permissions do not tell everything (read-only file systems, /proc): a folder is made there, and removed.
  const fs::path probe = existing / fmt::format("{}{}", staging_prefix, getpid());
  fs::create_directory(probe, error);
  if (error)
    throw OutputError(fmt::format("--out {}: nothing can be written in {} ({}); choose another place", folder.string(),
                                  existing.string(), error.message()));
  fs::remove(probe, error);
  for (const char* name : files)
    if (fs::is_directory(folder / name, error))
      throw OutputError(
          fmt::format("--out {}: {} is a folder where a file is to be written; move it away or choose another place",
                      folder.string(), (folder / name).string()));
}

std::vector<fs::path> write_whole(const fs::path& folder, std::span<const char* const> files,
                                  const std::function<std::vector<std::string>(const fs::path&)>& make) {
  // Staged inside the folder itself: the same file system, and no need to write beside it.
  const fs::path staging = folder / fmt::format("{}{}", staging_prefix, getpid());
  try {
    fs::create_directories(staging);
    remove_stale_stagings(folder);
    const std::vector<std::string> names = make(staging);
    std::vector<fs::path> written;
    for (const auto& name : names) {
      fs::rename(staging / name, folder / name);
      written.push_back(folder / name);
    }
    for (const char* name : files)
      if (std::find(names.begin(), names.end(), name) == names.end()) fs::remove(folder / name);  // of an earlier run
    fs::remove_all(staging);
    return written;
  } catch (const fs::filesystem_error& error) {
    std::error_code ignored;
    fs::remove_all(staging, ignored);
    const fs::path& file = error.path2().empty() ? error.path1() : error.path2();
    throw OutputError(fmt::format("--out {}: {} could not be written ({}); choose another place", folder.string(),
                                  file.string(), error.code().message()));
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(staging, ignored);
    throw;
  }
}

}  // namespace lagroid::app
