#include "output.hpp"

#include "report.hpp"

#include <H5Cpp.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <string_view>
#include <system_error>

namespace lagroid::app {

namespace {

namespace fs = std::filesystem;

/// All that a run can leave in its folder.
constexpr std::array<const char*, 7> output_files{"trajectory.h5", "trajectory.csv", "summary.json", "summary.txt",
                                                  "plot.gp",       "plot.svg",       "plot.png"};

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

/// Row `node` of a series; series on arrows have none at the first node.
const double* row(const Series& s, std::size_t node) {
  if (s.on_arrows) {
    if (node == 0) return nullptr;
    --node;
  }
  return s.values.data() + node * s.width();
}

void write_csv(const Trajectory& trajectory, const fs::path& file) {
  std::ofstream out(file);
  out << 't';
  for (const auto& s : trajectory.series)
    for (const auto& c : s.components) out << ',' << c;
  out << '\n';
  fmt::memory_buffer line;
  for (std::size_t node = 0; node < trajectory.time.size(); ++node) {
    line.clear();
    fmt::format_to(std::back_inserter(line), "{:.17g}", trajectory.time[node]);
    for (const auto& s : trajectory.series) {
      const double* values = row(s, node);
      for (std::size_t i = 0; i < s.width(); ++i) {
        if (values == nullptr) {
          line.push_back(',');
        } else {
          fmt::format_to(std::back_inserter(line), ",{:.17g}", values[i]);
        }
      }
    }
    line.push_back('\n');
    out.write(line.data(), std::streamsize(line.size()));
  }
  out.close();
  if (!out) throw OutputError(fmt::format("{}: could not be written; is the disk full?", file.string()));
}

void write_text(std::string_view text, const fs::path& file) {
  std::ofstream out(file, std::ios::binary);
  out.write(text.data(), std::streamsize(text.size()));
  out.close();
  if (!out) throw OutputError(fmt::format("{}: could not be written; is the disk full?", file.string()));
}

void attribute(const H5::H5Object& object, const std::string& name, const std::string& value) {
  const H5::StrType type(H5::PredType::C_S1, std::max<std::size_t>(1, value.size()));
  object.createAttribute(name, type, H5::DataSpace(H5S_SCALAR)).write(type, value.c_str());
}

/// The file is made in memory: HDF5 cannot survive a disk that is full (closing the file crashes, at exit at the
/// latest).
void write_hdf5(const RunResult& result, const fs::path& file) {
  H5::Exception::dontPrint();
  std::string image;
  try {
    H5::FileAccPropList in_memory;
    in_memory.setCore(/*increment=*/1 << 20, /*backing_store=*/false);
    H5::H5File out(file.string(), H5F_ACC_TRUNC, H5::FileCreatPropList::DEFAULT, in_memory);
    attribute(out, "system", result.system);
    attribute(out, "status", result.status);
    attribute(out, "generator", "lagroid");
    for (const auto& [name, value] : result.trajectory.conventions) attribute(out, "convention: " + name, value);
    const auto dataset = [&](const std::string& name, const std::vector<double>& values, std::size_t width) {
      std::string label = name;
      for (char& c : label)
        if (c == '/') c = '_';
      const std::size_t rows = width > 0 ? values.size() / width : 0;
      const hsize_t dimensions[2] = {rows, width};
      const H5::DataSpace space(width == 1 ? 1 : 2, dimensions);
      H5::DataSet set = out.createDataSet(label, H5::PredType::NATIVE_DOUBLE, space);
      if (!values.empty()) set.write(values.data(), H5::PredType::NATIVE_DOUBLE);
      return set;
    };
    attribute(dataset("time", result.trajectory.time, 1), "unit", "s");
    for (const auto& s : result.trajectory.series) {
      const H5::DataSet set = dataset(s.name, s.values, s.width());
      attribute(set, "unit", s.unit);
      attribute(set, "meaning", s.meaning);
      attribute(set, "components", fmt::format("{}", fmt::join(s.components, ", ")));
      attribute(set, "rows", s.on_arrows ? "one per recorded arrow" : "one per recorded node");
    }
    out.flush(H5F_SCOPE_GLOBAL);
    const auto size = H5Fget_file_image(out.getId(), nullptr, 0);
    if (size < 0) throw H5::FileIException("H5Fget_file_image", "no image of the file");
    image.resize(std::size_t(size));
    if (H5Fget_file_image(out.getId(), image.data(), image.size()) != size)
      throw H5::FileIException("H5Fget_file_image", "no image of the file");
  } catch (const H5::Exception& error) {
    throw OutputError(fmt::format("{}: HDF5: {}", file.string(), error.getDetailMsg()));
  }
  write_text(image, file);
}

/// A text as a gnuplot string: single quotes, no enhanced-text surprises.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

std::string gnuplot_script(const RunResult& result) {
  const std::size_t panels = result.panels.size();
  const std::size_t columns = panels > 1 ? 2 : 1;
  const std::size_t rows = (panels + columns - 1) / columns;
  std::string out = "# Draws trajectory.csv; run by lagroid, or by hand: gnuplot plot.gp\n";
  out += "set datafile separator ','\nset grid\n";
  const std::pair<const char*, std::string> terminals[] = {
      {"plot.svg", fmt::format("svg size {},{} background 'white' noenhanced", 520 * columns, 400 * rows)},
      {"plot.png", fmt::format("pngcairo size {},{} noenhanced", 520 * columns, 400 * rows)}};
  for (const auto& [file, terminal] : terminals) {
    out +=
        fmt::format("\nset terminal {}\nset output '{}'\nset multiplot layout {},{}\n", terminal, file, rows, columns);
    for (const auto& panel : result.panels) {
      out += panel.curves.size() > 1 ? "set key below\n" : "unset key\n";
      out += fmt::format("set title {}\nset xlabel {}\nset ylabel {}\n{}\nplot ", quoted(panel.title),
                         quoted(panel.x_label), quoted(panel.y_label),
                         panel.equal_axes ? "set size ratio -1" : "set size noratio");
      for (std::size_t i = 0; i < panel.curves.size(); ++i)
        out += fmt::format("{}'trajectory.csv' using (column({})):(column({})) with lines linewidth 1.5 title {}",
                           i ? ", " : "", quoted(panel.x), quoted(panel.curves[i]), quoted(panel.curves[i]));
      out += "\n";
    }
    out += "unset multiplot\nset output\n";
  }
  return out;
}

/// Runs gnuplot in `folder`; false with a reason when there is none or it fails.
bool run_gnuplot(const fs::path& folder, std::string& reason) {
  const pid_t child = fork();
  if (child < 0) {
    reason = "could not start a process";
    return false;
  }
  if (child == 0) {
    if (chdir(folder.c_str()) != 0) _exit(126);
    if (std::freopen("plot.log", "w", stderr) == nullptr || std::freopen("/dev/null", "w", stdout) == nullptr)
      _exit(126);
    execlp("gnuplot", "gnuplot", "plot.gp", static_cast<char*>(nullptr));
    _exit(127);
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0 && fs::exists(folder / "plot.svg") &&
      fs::exists(folder / "plot.png"))
    return true;
  std::ifstream log(folder / "plot.log");
  std::string first;
  for (std::string line; std::getline(log, line);)
    if (line.find("line") != std::string::npos && first.empty()) first = line;
  reason =
      WIFEXITED(status) && WEXITSTATUS(status) == 127
          ? "gnuplot is not installed (Debian package gnuplot-nox); run `gnuplot plot.gp` in the output folder later"
          : fmt::format("gnuplot failed{}", first.empty() ? "" : ": " + first);
  return false;
}

}  // namespace

void require_writable(const fs::path& folder) {
  if (folder.empty()) throw OutputError("--out: the folder's name is empty; give one, as in --out out/run");
  std::error_code error;
  fs::path existing = fs::absolute(folder);
  while (!fs::exists(existing, error) && existing.has_parent_path() && existing != existing.parent_path())
    existing = existing.parent_path();
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
  for (const char* name : output_files)
    if (fs::is_directory(folder / name, error))
      throw OutputError(
          fmt::format("--out {}: {} is a folder where a file is to be written; move it away or choose another place",
                      folder.string(), (folder / name).string()));
}

std::vector<fs::path> write_outputs(RunResult& result, const fs::path& folder) {
  // Staged inside the folder itself: the same file system, and no need to write beside it.
  const fs::path staging = folder / fmt::format("{}{}", staging_prefix, getpid());
  try {
    fs::create_directories(staging);
    remove_stale_stagings(folder);
    std::vector<std::string> names{"trajectory.h5", "trajectory.csv", "summary.json", "summary.txt"};
    write_hdf5(result, staging / "trajectory.h5");
    write_csv(result.trajectory, staging / "trajectory.csv");
    if (result.trajectory.time.size() > 1) {
      write_text(gnuplot_script(result), staging / "plot.gp");
      names.emplace_back("plot.gp");
      std::string reason;
      if (run_gnuplot(staging, reason)) {
        names.insert(names.end(), {"plot.svg", "plot.png"});
      } else {
        result.notes.push_back("no pictures: " + reason);
      }
    }
    write_text(json_report(result) + "\n", staging / "summary.json");
    write_text(text_report(result), staging / "summary.txt");
    std::vector<fs::path> written;
    for (const auto& name : names) {
      fs::rename(staging / name, folder / name);
      written.push_back(folder / name);
    }
    for (const char* name : output_files)
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
