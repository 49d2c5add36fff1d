#include "output.hpp"

#include "report.hpp"

#include <H5Cpp.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>

namespace lagroid::app {

namespace {

namespace fs = std::filesystem;

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

void attribute(const H5::H5Object& object, const std::string& name, const std::string& value) {
  const H5::StrType type(H5::PredType::C_S1, std::max<std::size_t>(1, value.size()));
  object.createAttribute(name, type, H5::DataSpace(H5S_SCALAR)).write(type, value.c_str());
}

void write_hdf5(const RunResult& result, const fs::path& file) {
  H5::Exception::dontPrint();
  try {
    H5::H5File out(file.string(), H5F_ACC_TRUNC);
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
    out.close();
  } catch (const H5::Exception& error) {
    throw OutputError(fmt::format("{}: HDF5: {}", file.string(), error.getDetailMsg()));
  }
}

void write_text(const std::string& text, const fs::path& file) {
  std::ofstream out(file);
  out << text;
  out.close();
  if (!out) throw OutputError(fmt::format("{}: could not be written; is the disk full?", file.string()));
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
  if (access(existing.c_str(), W_OK | X_OK) != 0)
    throw OutputError(fmt::format("--out {}: no permission to write in {}; choose another place", folder.string(),
                                  existing.string()));
}

std::vector<fs::path> write_outputs(RunResult& result, const fs::path& folder) {
  // Staged inside the folder itself: the same file system, and no need to write beside it.
  const fs::path staging = folder / fmt::format(".partial-{}", getpid());
  const std::vector<std::string> pictures{"plot.svg", "plot.png"};
  try {
    fs::create_directories(staging);
    std::vector<std::string> names{"trajectory.h5", "trajectory.csv", "summary.json", "summary.txt"};
    write_hdf5(result, staging / "trajectory.h5");
    write_csv(result.trajectory, staging / "trajectory.csv");
    if (result.trajectory.time.size() > 1) {
      write_text(gnuplot_script(result), staging / "plot.gp");
      names.emplace_back("plot.gp");
      std::string reason;
      if (run_gnuplot(staging, reason)) {
        names.insert(names.end(), pictures.begin(), pictures.end());
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
    for (const auto& name : pictures)
      if (std::find(names.begin(), names.end(), name) == names.end()) fs::remove(folder / name);  // of an earlier run
    fs::remove_all(staging);
    return written;
  } catch (const fs::filesystem_error& error) {
    std::error_code ignored;
    fs::remove_all(staging, ignored);
    throw OutputError(fmt::format("--out {}: {}", folder.string(), error.code().message()));
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(staging, ignored);
    throw;
  }
}

}  // namespace lagroid::app
