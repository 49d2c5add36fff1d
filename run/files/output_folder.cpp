#include <lagroid/run/files/kept_file.hpp>
#include <lagroid/run/files/nesting.hpp>
#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/run/interrupt.hpp>
#include <lagroid/run/process.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <fstream>
#include <system_error>
#include <thread>

namespace lagroid {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view staging_prefix = ".partial-";
constexpr const char* mark_file = ".lagroid";
constexpr const char* lock_file = ".lock";
constexpr const char* gnuplot_log = "plot.log";

/// How a kind is called, and the files of which one at least is there as soon as anything of it is.
struct KindOfOutput {
  OutputKind kind;
  const char* name;  ///< in the mark
  const char* told;
  std::vector<const char*> signs;
};

const std::vector<KindOfOutput>& kinds() {
  static const std::vector<KindOfOutput> all{
      {OutputKind::run, "run", "a run", {"checkpoint/scene.toml", "trajectory.csv", "trajectory.h5"}},
      {OutputKind::sweep, "sweep", "a sweep", {"sweep.cbor", "sweep.h5"}},
      {OutputKind::study, "study", "a study", {"study.json"}},
      {OutputKind::optimum, "optimum", "an optimisation", {"result.h5", "control.h5"}},
      {OutputKind::model, "model", "a learned model", {"model.json"}},
      {OutputKind::report, "report", "a report", {"figures.gp"}},
      {OutputKind::data, "data", "data", {}}};
  return all;
}

const KindOfOutput& description(OutputKind kind) {
  return *std::find_if(kinds().begin(), kinds().end(), [&](const KindOfOutput& each) { return each.kind == kind; });
}

/// The first sign of that kind; null where there is none.
const char* sign_of(const fs::path& folder, const KindOfOutput& kind) {
  std::error_code ignored;
  const auto there = std::find_if(kind.signs.begin(), kind.signs.end(),
                                  [&](const char* s) { return fs::exists(folder / s, ignored); });
  return there == kind.signs.end() ? nullptr : *there;
}

/// What is said of a folder whose source differs in that.
std::string difference(const std::string& name) {
  if (name == "sweep") return "of another sweep file, or with other overrides";
  if (name == "scene") return "of another scene, or with other overrides";
  if (name == "members") return "of other members";
  if (name == "data") return "of other data";
  if (name == "options") return "made with other options";
  return "of another " + name;
}

using OrderedJson = nlohmann::ordered_json;

OrderedJson mark_of(OutputKind kind, const OutputSource& source) {
  OrderedJson mark{{"kind", description(kind).name}, {"of", OrderedJson::object()}};
  for (const auto& [name, text] : source) mark["of"][name] = sum_of(text);
  return mark;
}

/// The mark of a folder; null where there is none, or none that can be read.
OrderedJson read_mark(const fs::path& folder) {
  const OrderedJson mark = read_json(contents(folder / mark_file).value_or("")).value_or(OrderedJson());
  const bool whole = mark.is_object() && mark.contains("kind") && mark["kind"].is_string() && mark.contains("of") &&
                     mark["of"].is_object();
  return whole ? mark : OrderedJson();
}

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

/// A full disk is no mistake on the command line.
[[noreturn]] void refuse_place(const fs::path& folder, const fs::path& where, std::error_code why) {
  const auto line = fmt::format("{}: nothing can be written in {} ({}); choose another place", folder.string(),
                                where.string(), why.message());
  if (why == std::errc::no_space_on_device || why.value() == EDQUOT) throw OutputError(line);
  throw FolderRefused(line);
}

/// Whether a picture (SVG or PNG) is there to its end: gnuplot does not notice a full disk.
bool is_whole(const fs::path& picture) {
  const std::string bytes = contents(picture).value_or("");
  const std::string_view end = picture.extension() == ".svg" ? "</svg>" : "IEND";
  constexpr std::size_t last = 16;  // what may follow it
  return bytes.find(end, bytes.size() - std::min(bytes.size(), last)) != std::string::npos;
}

/// Runs gnuplot on a script in `folder`. Empty, or the reason why one of the pictures is missing.
std::string run_gnuplot(const fs::path& folder, const Drawing& drawing, bool before) {
  const auto stopped = [&] {
    return before || !InterruptGuard::interrupted()
               ? std::string()
               : fmt::format("interrupted; run `gnuplot {}` in the output folder later", drawing.script);
  };
  if (const std::string why = stopped(); !why.empty()) return why;
  int code = 0;
  try {
    Process gnuplot({"gnuplot", drawing.script}, {.folder = folder, .out = "/dev/null", .error = gnuplot_log});
    while (gnuplot.running()) {
      if (!before && InterruptGuard::interrupted()) gnuplot.kill();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    code = gnuplot.wait();
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::no_such_file_or_directory)
      return fmt::format("{}; run `gnuplot {}` in the output folder later", error.what(), drawing.script);
    return fmt::format(
        "gnuplot is not installed (Debian package gnuplot-nox); run `gnuplot {}` in the output folder later",
        drawing.script);
  }
  if (const std::string why = stopped(); !why.empty()) return why;
  const bool drawn = std::all_of(drawing.pictures.begin(), drawing.pictures.end(),
                                 [&](const std::string& picture) { return is_whole(folder / picture); });
  if (code == 0 && drawn) return "";
  std::ifstream log(folder / gnuplot_log);
  std::string first;
  for (std::string line; std::getline(log, line);)
    if (line.find("line") != std::string::npos && first.empty()) first = line;
  if (code == 0) return "gnuplot did not draw all pictures to their ends; is the disk full?";
  return fmt::format("gnuplot failed{}", first.empty() ? "" : ": " + first);
}

}  // namespace

void write_text(std::string_view text, const fs::path& file) {
  std::error_code ignored;
  if (fs::is_symlink(file, ignored)) fs::remove(file, ignored);  // what it leads to is not ours
  std::ofstream out(file, std::ios::binary);
  out.write(text.data(), std::streamsize(text.size()));
  out.close();
  if (!out) throw OutputError(fmt::format("{}: could not be written; is the disk full?", file.string()));
}

OutputFolder::OutputFolder(fs::path folder, OutputKind kind, const std::optional<OutputSource>& source,
                           std::span<const char* const> files)
    : folder_(std::move(folder)), kind_(kind) {
  require_writable(folder_, files);
  fs::path missing = fs::absolute(folder_).lexically_normal();
  if (!missing.has_filename()) missing = missing.parent_path();  // a stroke at the end
  std::error_code error;
  for (; !fs::exists(missing, error) && missing.has_relative_path(); missing = missing.parent_path())
    made_.push_back(missing);
  fs::create_directories(folder_, error);
  if (error) refuse_place(folder_, folder_, error);
  try {
    lock();
    remove_stale_stagings(folder_);
    refuse_others(source);
    if (source && !known_) {
      ours_ = !fs::exists(folder_ / mark_file, error);
      replace_file(folder_ / mark_file, mark_of(kind_, *source).dump(2) + "\n");
    }
  } catch (...) {
    leave();
    throw;
  }
}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : folder_(std::move(other.folder_)),
      kind_(other.kind_),
      made_(std::exchange(other.made_, {})),
      lock_(std::exchange(other.lock_, -1)),
      known_(other.known_),
      ours_(std::exchange(other.ours_, false)) {}

OutputFolder::~OutputFolder() { leave(); }

void OutputFolder::disown() {
  std::error_code ignored;
  if (std::exchange(ours_, false)) fs::remove(folder_ / mark_file, ignored);
}

void OutputFolder::leave() {
  std::error_code ignored;
  if (ours_ && sign_of(folder_, description(kind_)) == nullptr) fs::remove(folder_ / mark_file, ignored);
  if (lock_ >= 0 && ::flock(lock_, LOCK_EX | LOCK_NB) == 0) fs::remove(folder_ / lock_file, ignored);
  if (lock_ >= 0) ::close(lock_);
  for (const fs::path& each : made_) fs::remove(each, ignored);  // where nothing is in it
}

/// Of data, any number of processes share a folder; all else needs it for itself. The file goes with the last of them:
/// whoever holds one that was taken away meanwhile tries again.
void OutputFolder::lock() {
  const fs::path file = folder_ / lock_file;
  const int wanted = (kind_ == OutputKind::data ? LOCK_SH : LOCK_EX) | LOCK_NB;
  for (;;) {
    lock_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
    if (lock_ < 0) refuse_place(folder_, file, std::error_code(errno, std::generic_category()));
    if (::flock(lock_, wanted) != 0) {
      const bool busy = errno == EWOULDBLOCK;
      ::close(std::exchange(lock_, -1));
      throw FolderRefused(busy ? fmt::format("{}: another run is at work there; wait for it, or choose another folder",
                                             folder_.string())
                               : fmt::format("{}: cannot be locked; choose another place", file.string()));
    }
    struct stat held {};
    struct stat there {};
    if (::fstat(lock_, &held) == 0 && ::stat(file.c_str(), &there) == 0 && held.st_ino == there.st_ino &&
        held.st_dev == there.st_dev)
      return;
    ::close(lock_);
  }
}

void OutputFolder::refuse_others(const std::optional<OutputSource>& source) {
  const auto refuse = [&](const KindOfOutput& there, const std::string& more) {
    throw FolderRefused(fmt::format("{}: it holds {}{}; choose another folder, or remove this one", folder_.string(),
                                    there.told, more));
  };
  const OrderedJson mark = read_mark(folder_);
  if (std::error_code ignored; kind_ != OutputKind::data && mark.is_null() && fs::exists(folder_ / mark_file, ignored))
    throw FolderRefused(
        fmt::format("{}: {}, which says what the folder holds, is damaged; choose another folder, or remove this one",
                    folder_.string(), mark_file));
  const auto there = [&](const KindOfOutput& kind) { return sign_of(folder_, kind) != nullptr; };
  auto held = std::find_if(kinds().begin(), kinds().end(), [&](const KindOfOutput& each) {
    return mark.is_object() && mark["kind"] == each.name && there(each);
  });
  known_ = held != kinds().end();
  // Without a mark it is what its files say. Data, which lie in any folder, leave such a one alone.
  if (!known_ && (kind_ == OutputKind::data || there(description(kind_)))) return;
  if (!known_) held = std::find_if(kinds().begin(), kinds().end(), there);
  if (held == kinds().end()) return;
  if (held->kind != kind_ && !source)
    throw FolderRefused(fmt::format("{}: it holds {} ({}), and not {}", folder_.string(), held->told,
                                    sign_of(folder_, *held), description(kind_).told));
  if (held->kind != kind_) refuse(*held, fmt::format(" ({}), whose files would be lost", sign_of(folder_, *held)));
  if (!source) return;
  const OrderedJson ours = mark_of(kind_, *source)["of"];
  for (const auto& [name, sum] : ours.items())
    if (!mark["of"].contains(name) || mark["of"][name] != sum) refuse(*held, " " + difference(name));
}

void require_writable(const fs::path& folder, std::span<const char* const> files) {
  if (folder.empty()) throw FolderRefused("the name of the output folder is empty; give one, as in out/run");
  std::error_code error;
  fs::path existing = fs::absolute(folder);
  while (!fs::exists(existing, error) && existing.has_parent_path() && existing != existing.parent_path())
    existing = existing.parent_path();
  if (fs::is_symlink(folder, error) && !fs::exists(folder, error))
    throw FolderRefused(fmt::format("{}: a link to nothing; choose another place", folder.string()));
  if (!fs::is_directory(existing, error))
    throw FolderRefused(
        fmt::format("{}: {} is not a folder; choose another place", folder.string(), existing.string()));
  // Permissions do not tell everything (read-only file systems, /proc): a folder is made there, and removed.
  const fs::path probe = existing / fmt::format("{}{}", staging_prefix, getpid());
  fs::create_directory(probe, error);
  if (error) refuse_place(folder, existing, error);
  fs::remove(probe, error);
  for (const char* name : files)
    if (fs::is_directory(folder / name, error))
      throw FolderRefused(
          fmt::format("{}: {} is a folder where a file is to be written; move it away or choose another place",
                      folder.string(), (folder / name).string()));
}

std::vector<fs::path> write_whole(const fs::path& folder, std::span<const char* const> files, const FileWriter& make) {
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
    throw OutputError(fmt::format("{}: {} could not be written ({}); choose another place", folder.string(),
                                  file.string(), error.code().message()));
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(staging, ignored);
    throw;
  }
}

std::string draw(const fs::path& folder, const Drawing& drawing, bool interrupted_before) {
  const fs::path staging = folder / fmt::format("{}{}", staging_prefix, getpid());
  std::error_code ignored;
  try {
    fs::create_directories(staging);
    // What gnuplot writes is no link: it would write into what stands in the folder, or where that leads.
    std::vector<std::string> made = drawing.pictures;
    made.emplace_back(gnuplot_log);
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      if (entry.is_regular_file() && name.front() != '.' && std::find(made.begin(), made.end(), name) == made.end())
        fs::create_symlink(fs::absolute(entry.path()), staging / name);
    }
    std::string reason = run_gnuplot(staging, drawing, interrupted_before);
    if (reason.empty())
      for (const std::string& picture : drawing.pictures) fs::rename(staging / picture, folder / picture);
    fs::remove_all(staging, ignored);
    return reason;
  } catch (const fs::filesystem_error& error) {
    fs::remove_all(staging, ignored);
    return fmt::format("{}: {}", error.path1().string(), error.code().message());
  }
}

std::vector<fs::path> write_and_draw(const fs::path& folder, std::span<const char* const> files, const FileWriter& make,
                                     const Drawing& drawing, std::string& note,
                                     const std::function<std::vector<std::string>(const fs::path&, bool)>& tell) {
  const InterruptGuard guard;
  const bool before = InterruptGuard::interrupted();
  auto written = write_whole(folder, files, [&](const fs::path& staging) {
    std::vector<std::string> names = make(staging);
    if (!tell) return names;
    const auto told = tell(staging, false);
    names.insert(names.end(), told.begin(), told.end());
    return names;
  });
  if (drawing.script.empty()) return written;
  note = draw(folder, drawing, before);
  if (!note.empty()) return written;
  if (tell) write_whole(folder, {}, [&](const fs::path& staging) { return tell(staging, true); });
  for (const std::string& picture : drawing.pictures) written.push_back(folder / picture);
  return written;
}

}  // namespace lagroid
