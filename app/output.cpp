#include "output.hpp"

#include "hdf5_file.hpp"
#include "report.hpp"
#include "scene_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

namespace lagroid::app {

namespace {

namespace fs = std::filesystem;

/// All that a run can leave in its folder.
constexpr std::array<const char*, 8> output_files{"trajectory.h5", "trajectory.csv", "summary.json", "summary.txt",
                                                  "plot.csv",      "plot.gp",        "plot.svg",     "plot.png"};

/// gnuplot looks for a column by its name in every row: of wide files it gets an excerpt.
constexpr std::size_t most_columns_for_gnuplot = 200;

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

/// Joined by ", ", in as many parts as attributes of 64 KiB have to be.
std::vector<std::string> joined_in_parts(const std::vector<std::string>& labels) {
  constexpr std::size_t most = 60'000;
  std::vector<std::string> parts(1);
  for (const std::string& label : labels) {
    if (parts.back().size() + label.size() > most) parts.emplace_back();
    parts.back() += parts.back().empty() ? label : ", " + label;
  }
  return parts;
}

void write_trajectory(const RunResult& result, const fs::path& file) {
  write_hdf5(file, [&](const H5::H5File& out) {
    set_attribute(out, "system", result.system);
    set_attribute(out, "status", result.status);
    set_attribute(out, "generator", "lagroid");
    for (const auto& [name, value] : result.trajectory.conventions) set_attribute(out, "convention: " + name, value);
    set_attribute(add_dataset(out, "time", result.trajectory.time, 1), "unit", "s");
    for (const auto& s : result.trajectory.series) {
      const H5::DataSet set = add_dataset(out, s.name, s.values, s.width());
      set_attribute(set, "unit", s.unit);
      set_attribute(set, "meaning", s.meaning);
      const auto labels = joined_in_parts(s.components);
      for (std::size_t part = 0; part < labels.size(); ++part)
        set_attribute(set, components_attribute(part), labels[part]);
      set_attribute(set, "rows", s.on_arrows ? "one per recorded arrow" : "one per recorded node");
    }
  });
}

/// A text as a gnuplot string: single quotes, no enhanced-text surprises.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

/// The time, and the series that hold a column of a panel.
Trajectory excerpt_for_plots(const RunResult& result) {
  const auto plotted = [&](const std::string& column) {
    return std::any_of(result.panels.begin(), result.panels.end(), [&](const Panel& panel) {
      return panel.x == column || std::find(panel.curves.begin(), panel.curves.end(), column) != panel.curves.end();
    });
  };
  Trajectory out;
  out.time = result.trajectory.time;
  for (const auto& s : result.trajectory.series)
    if (std::any_of(s.components.begin(), s.components.end(), plotted)) out.series.push_back(s);
  return out;
}

std::string gnuplot_script(const RunResult& result, const std::string& data) {
  const std::size_t panels = result.panels.size();
  const std::size_t columns = panels > 1 ? 2 : 1;
  const std::size_t rows = (panels + columns - 1) / columns;
  std::string out = fmt::format("# Draws {}; run by lagroid, or by hand: gnuplot plot.gp\n", data);
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
        out += fmt::format("{}'{}' using (column({})):(column({})) with lines linewidth 1.5 title {}", i ? ", " : "",
                           data, quoted(panel.x), quoted(panel.curves[i]), quoted(panel.curves[i]));
      out += "\n";
    }
    out += "unset multiplot\nset output\n";
  }
  return out;
}

}  // namespace

OutputFolder folder_for_run(const fs::path& folder, const Section& scene) {
  return {folder, OutputKind::run, OutputSource{{"scene", scene.whole()}}, output_files};
}

OutputFolder folder_for_result(const fs::path& folder, const RunResult& result) {
  // No two runs take equally long.
  const std::string which = fmt::format("{} {} {} {:.17g}", result.system, result.method, result.steps, result.seconds);
  return {folder, OutputKind::run, OutputSource{{"result", which}}, output_files};
}

OutputFolder folder_of_run(const fs::path& folder) { return {folder, OutputKind::run, std::nullopt, output_files}; }

std::vector<fs::path> write_outputs(RunResult& result, const fs::path& folder) {
  const auto summarise = [&](const fs::path& staging) {
    write_text(json_report(result) + "\n", staging / "summary.json");
    write_text(text_report(result), staging / "summary.txt");
    return std::vector<std::string>{"summary.json", "summary.txt"};
  };
  Drawing drawing;
  const auto make = [&](const fs::path& staging) {
    std::vector<std::string> names = summarise(staging);
    names.insert(names.end(), {"trajectory.h5", "trajectory.csv"});
    write_trajectory(result, staging / "trajectory.h5");
    write_csv(result.trajectory, staging / "trajectory.csv");
    if (result.trajectory.time.size() > 1) {
      std::size_t columns = 0;
      for (const auto& s : result.trajectory.series) columns += s.width();
      std::string data = "trajectory.csv";
      if (columns > most_columns_for_gnuplot) {
        data = "plot.csv";
        write_csv(excerpt_for_plots(result), staging / data);
        names.push_back(data);
      }
      write_text(gnuplot_script(result, data), staging / "plot.gp");
      names.emplace_back("plot.gp");
      drawing = {"plot.gp", {"plot.svg", "plot.png"}};
    }
    return names;
  };
  std::string note;
  auto written = write_and_draw(folder, output_files, make, drawing, note);
  if (note.empty()) return written;
  result.notes.push_back("no pictures: " + note);
  write_whole(folder, {}, summarise);
  return written;
}

}  // namespace lagroid::app
