#include <lagroid/run/files/hdf5_file.hpp>
#include <lagroid/run/files/output.hpp>
#include <lagroid/run/interrupt.hpp>
#include <lagroid/run/reports/curves.hpp>
#include <lagroid/run/reports/gnuplot.hpp>
#include <lagroid/run/reports/markup.hpp>
#include <lagroid/run/reports/report.hpp>
#include <lagroid/run/reports/text.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

namespace lagroid {

namespace {

namespace fs = std::filesystem;

/// All that a run can leave in its folder.
constexpr std::array<const char*, 9> output_files{"trajectory.h5", "trajectory.csv", "events.csv",
                                                  "summary.json",  "summary.txt",    "plot.csv",
                                                  "plot.gp",       "plot.svg",       "plot.png"};

/// gnuplot reads the whole file for every curve, and looks for its columns by their names in every row: of long and of
/// wide files it gets what can be seen.
constexpr std::size_t most_rows_for_gnuplot = 10'000;
constexpr std::size_t most_columns_for_gnuplot = 200;

/// Row `node` of a series; series on arrows have none at the first node.
const double* row(const Columns& s, std::size_t node) {
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
    for (const auto& c : s.components) out << ',' << in_csv(c);
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

void write_events(const EventTable& events, const fs::path& file) {
  std::string out = "event,t,t_error,step,passing,together";
  for (const std::string& column : events.columns) out += "," + in_csv(column);
  out += '\n';
  for (const Happening& row : events.rows) {
    out += fmt::format("{},{:.17g},{:.2g},{},{},{}", in_csv(events.watched[row.event].name), row.time, row.time_error,
                       row.step, to_string(row.passing), int(row.together));
    for (const double value : row.values) out += fmt::format(",{:.17g}", value);
    out += '\n';
  }
  write_text(out, file);
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

/// The group "events": which, when, how, and the columns of the state there.
void add_events(const H5::H5File& out, const EventTable& events) {
  const H5::Group group = out.createGroup("events");
  std::vector<std::string> names, passing;
  std::vector<double> time, error, values;
  for (const Happening& row : events.rows) {
    names.push_back(events.watched[row.event].name);
    passing.emplace_back(to_string(row.passing));
    time.push_back(row.time);
    error.push_back(row.time_error);
    values.insert(values.end(), row.values.begin(), row.values.end());
  }
  set_attribute(add_dataset(group, "time", time, 1), "unit", "s");
  set_attribute(add_dataset(group, "time_error", error, 1), "unit", "s");
  if (events.rows.empty()) return;
  add_texts(group, "event", names);
  add_texts(group, "passing", passing);
  const H5::DataSet state = add_dataset(group, "values", values, events.columns.size());
  const auto labels = joined_in_parts(events.columns);
  for (std::size_t part = 0; part < labels.size(); ++part)
    set_attribute(state, components_attribute(part), labels[part]);
}

bool is_for_gnuplot(const Trajectory& trajectory) {
  std::size_t columns = 0;
  for (const auto& s : trajectory.series) columns += s.width();
  return trajectory.time.size() <= most_rows_for_gnuplot && columns <= most_columns_for_gnuplot;
}

/// What gnuplot takes for x and y of a curve of the panel: columns of the trajectory by their names, or those of the
/// panel's block of the excerpt by their numbers.
std::string gnuplot_columns(const Panel& panel, std::size_t curve, bool by_name) {
  const auto shown = [](const std::string& column, double offset) {
    return offset == 0 ? fmt::format("({})", column) : fmt::format("({}-({}))", column, offset);
  };
  const std::string x = by_name ? fmt::format("column({})", gnuplot_string(panel.x)) : "$1";
  const std::string y =
      by_name ? fmt::format("column({})", gnuplot_string(panel.curves[curve])) : fmt::format("${}", curve + 2);
  return shown(x, panel.x_offset) + ":" + shown(y, panel.y_offset);
}

/// The events that are drawn as sections, and happened.
std::vector<std::size_t> sections_of(const EventTable& events) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < events.watched.size(); ++i)
    if (!events.watched[i].plot.empty() && events.watched[i].count > 0) out.push_back(i);
  return out;
}

/// Where something happened on a curve, if its columns are known there.
std::string marks_on(const Panel& panel, const std::string& curve, const EventTable& events) {
  const auto known = [&](const std::string& column) {
    return column == "t" || std::find(events.columns.begin(), events.columns.end(), column) != events.columns.end();
  };
  const bool happened = std::any_of(events.watched.begin(), events.watched.end(),
                                    [](const WatchedEvent& e) { return e.count + e.touches > 0; });
  if (!happened || !known(panel.x) || !known(curve)) return "";
  return fmt::format(
      ", 'events.csv' using (column({})-({})):(column({})-({})) with points pointtype 6 pointsize 0.6 "
      "linecolor 'black' notitle",
      gnuplot_string(panel.x), panel.x_offset, gnuplot_string(curve), panel.y_offset);
}

std::string section(const WatchedEvent& event) {
  return fmt::format(
      "unset key\nset title {}\nset xlabel {}\nset ylabel {}\nset size noratio\n"
      "plot 'events.csv' using (stringcolumn('event') eq {} ? column({}) : NaN):(column({})) "
      "with points pointtype 7 pointsize 0.4\n",
      gnuplot_string(event.name), gnuplot_string(event.plot[0]), gnuplot_string(event.plot[1]),
      gnuplot_string(event.name), gnuplot_string(event.plot[0]), gnuplot_string(event.plot[1]));
}

}  // namespace

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
    if (!result.events.watched.empty()) add_events(out, result.events);
  });
}

std::string plot_script(const std::vector<Panel>& panels, const EventTable& events, bool by_name) {
  const std::string data = by_name ? "trajectory.csv" : "plot.csv";
  const std::vector<std::size_t> sections = sections_of(events);
  const std::size_t pictures = panels.size() + sections.size();
  const std::size_t columns = pictures > 1 ? 2 : 1;
  const std::size_t rows = (pictures + columns - 1) / columns;
  std::string out = fmt::format("# Draws {}; run by lagroid, or by hand: gnuplot plot.gp\n", data);
  // A constant at the end of an axis is not to lie on the frame.
  out += "set datafile separator ','\nset grid\nset offsets graph 0, 0, 0.03, 0.03\n";
  const std::pair<const char*, std::string> terminals[] = {
      {"plot.svg", fmt::format("svg size {},{} background 'white' noenhanced", 520 * columns, 400 * rows)},
      {"plot.png", fmt::format("pngcairo size {},{} noenhanced", 520 * columns, 400 * rows)}};
  for (const auto& [file, terminal] : terminals) {
    out +=
        fmt::format("\nset terminal {}\nset output '{}'\nset multiplot layout {},{}\n", terminal, file, rows, columns);
    for (std::size_t p = 0; p < panels.size(); ++p) {
      const Panel& panel = panels[p];
      out += panel.curves.size() > 1 ? "set key below\n" : "unset key\n";
      out += fmt::format("set title {}\nset xlabel {}\nset ylabel {}\n{}\nplot ", gnuplot_string(panel.title),
                         gnuplot_string(label_of(panel.x_label, panel.x_offset)),
                         gnuplot_string(label_of(panel.y_label, panel.y_offset)),
                         panel.equal_axes ? "set size ratio -1" : "set size noratio");
      for (std::size_t i = 0; i < panel.curves.size(); ++i)
        out += fmt::format("{}'{}'{} using {} with lines linewidth 1.5 title {}", i ? ", " : "", data,
                           by_name ? "" : fmt::format(" index {}", p), gnuplot_columns(panel, i, by_name),
                           gnuplot_string(panel.curves[i]));
      for (const std::string& curve : panel.curves) out += marks_on(panel, curve, events);
      out += "\n";
    }
    for (const std::size_t i : sections) out += section(events.watched[i]);
    out += "unset multiplot\nset output\n";
  }
  return out;
}

OutputFolder folder_for_run(const fs::path& folder, const std::string& scene) {
  return {folder, OutputKind::run, OutputSource{{"scene", scene}}, output_files};
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
    write_text(visible(text_report(result), "\n"), staging / "summary.txt");
    return std::vector<std::string>{"summary.json", "summary.txt"};
  };
  Drawing drawing;
  const auto make = [&](const fs::path& staging) {
    const bool moves = result.trajectory.time.size() > 1;
    if (moves)
      for (Panel& panel : result.panels) take_offsets(panel, result.trajectory);
    std::vector<std::string> names = summarise(staging);
    names.insert(names.end(), {"trajectory.h5", "trajectory.csv"});
    write_trajectory(result, staging / "trajectory.h5");
    write_csv(result.trajectory, staging / "trajectory.csv");
    if (!result.events.watched.empty()) {
      write_events(result.events, staging / "events.csv");
      names.emplace_back("events.csv");
    }
    if (moves) {
      const bool by_name = is_for_gnuplot(result.trajectory);
      if (!by_name) {
        write_text(table_of_visible(result.panels, result.trajectory), staging / "plot.csv");
        names.emplace_back("plot.csv");
      }
      write_text(plot_script(result.panels, result.events, by_name), staging / "plot.gp");
      names.emplace_back("plot.gp");
      drawing = {"plot.gp", {"plot.svg", "plot.png"}};
    }
    return names;
  };
  std::string note;
  auto written = write_and_draw(folder, output_files, make, drawing, note);
  if (note.empty()) return written;
  result.notes.push_back("no pictures: " + visible(note));
  write_whole(folder, {}, summarise);
  return written;
}

std::vector<fs::path> write_outputs_if_possible(RunResult& result, const fs::path& folder) {
  const InterruptGuard guard;
  try {
    return write_outputs(result, folder);
  } catch (const OutputError& error) {
    result.output_error = error.what();
    return {};
  }
}

}  // namespace lagroid
