#include "sweep_files.hpp"

#include <lagroid/run/files/hdf5_file.hpp>
#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/run/machine.hpp>
#include <lagroid/run/reports/gnuplot.hpp>
#include <lagroid/run/reports/markup.hpp>
#include <lagroid/run/reports/text.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace lagroid::app {

const std::vector<const char*> sweep_files{"sweep.h5", "members.csv", "summary.json", "summary.txt",
                                           "plot.gp",  "plot.svg",    "plot.png"};

namespace {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;

constexpr std::size_t most_cells_in_csv = 4'000'000;
constexpr long most_points_in_picture = 1'000'000;
constexpr std::size_t most_failures_told = 5;

/// Least, mean and largest of the numbers that are there.
struct Range {
  long count = 0;
  double least = std::numeric_limits<double>::infinity();
  double largest = -std::numeric_limits<double>::infinity();
  double mean = 0;
};

Range range_of(const std::vector<double>& values) {
  Range out;
  double sum = 0;
  for (const double x : values) {
    if (!std::isfinite(x)) continue;
    ++out.count;
    out.least = std::min(out.least, x);
    out.largest = std::max(out.largest, x);
    sum += x;
  }
  out.mean = sum / double(out.count);
  return out;
}

std::map<std::string, long> statuses(const SweepPart& members) {
  std::map<std::string, long> out;
  for (const std::string& status : members.status()) ++out[status];
  return out;
}

/// The numbers of one key's column.
std::vector<double> key_values(const Design& design, std::size_t column) {
  std::vector<double> out;
  for (std::size_t i = column; i < design.values.size(); i += design.width()) out.push_back(design.values[i]);
  return out;
}

/// "final/px" as group and label.
std::pair<std::string, std::string> group_and_label(const std::string& name) {
  const auto slash = name.find('/');
  return {name.substr(0, slash), name.substr(slash + 1)};
}

class Groups {
 public:
  explicit Groups(const H5::H5File& file) : file_(file) {}
  const H5::Group& operator[](const std::string& name) {
    auto& group = groups_[name];
    if (!group) group = file_.createGroup(name);
    return *group;
  }

 private:
  const H5::H5File& file_;
  std::map<std::string, std::optional<H5::Group>> groups_;
};

void write_data(const SweepScene& sweep, const SweepResult& result, const fs::path& file) {
  write_hdf5(file, [&](const H5::H5File& out) {
    set_attribute(out, "generator", "lagroid");
    set_attribute(out, "program", program());
    set_attribute(out, "engine", result.engine);
    Groups groups(out);
    const std::vector<std::string> texts{sweep.text, sweep.scene.whole()};
    add_texts(groups["input"], "sweep.toml", {texts[0]});
    add_texts(groups["input"], "scene.toml", {texts[1]});
    const SweepPart& members = result.members;
    add_texts(groups["run"], "status", members.status());
    std::vector<double> failed;
    std::vector<std::string> messages;
    for (const auto& [member, message] : members.messages()) {
      failed.push_back(double(member));
      messages.push_back(message);
    }
    if (!failed.empty()) {
      add_dataset(groups["failures"], "member", failed, 1);
      add_texts(groups["failures"], "message", messages);
    }
    const std::vector<std::string> keys = sweep.design.columns();
    for (std::size_t i = 0; i < keys.size(); ++i)
      set_attribute(add_dataset(groups["keys"], keys[i], key_values(sweep.design, i), 1), "meaning",
                    "what the member has at this key of the scene");
    for (const Column& column : members.columns()) {
      const auto [group, label] = group_and_label(column.name);
      const H5::DataSet set = add_dataset(groups[group], label, column.values, 1);
      set_attribute(set, "unit", column.unit);
      set_attribute(set, "meaning", column.meaning);
    }
    for (const SeriesColumn& column : members.series()) {
      std::size_t longest = 1;
      for (const auto& values : column.values) longest = std::max(longest, values.size());
      std::vector<double> table(column.values.size() * longest, std::numeric_limits<double>::quiet_NaN());
      for (std::size_t i = 0; i < column.values.size(); ++i)
        std::copy(column.values[i].begin(), column.values[i].end(), table.begin() + std::ptrdiff_t(i * longest));
      const auto [group, label] = group_and_label(column.name);
      const H5::DataSet set = add_dataset(groups[group], label, table, longest);
      set_attribute(set, "unit", column.unit);
      set_attribute(set, "meaning", column.meaning);
      set_attribute(set, "rows", "a member each, its recorded nodes in order; NaN after its last");
    }
  });
}

void write_csv(const SweepScene& sweep, const SweepPart& members, const fs::path& file) {
  std::ofstream out(file);
  out << "member,status";
  for (const std::string& key : sweep.design.columns()) out << ',' << in_csv(key);
  for (const Column& column : members.columns()) out << ',' << in_csv(column.name);
  out << '\n';
  fmt::memory_buffer line;
  const std::size_t width = sweep.design.width();
  for (std::size_t i = 0; i < members.status().size(); ++i) {
    line.clear();
    fmt::format_to(std::back_inserter(line), "{},{}", i, members.status()[i]);
    for (std::size_t k = 0; k < width; ++k)
      fmt::format_to(std::back_inserter(line), ",{:.17g}", sweep.design.values[i * width + k]);
    for (const Column& column : members.columns())
      fmt::format_to(std::back_inserter(line), ",{:.17g}", column.values[i]);
    line.push_back('\n');
    out.write(line.data(), std::streamsize(line.size()));
  }
  out.close();
  if (!out) throw OutputError(fmt::format("{}: could not be written; is the disk full?", file.string()));
}

/// [plot], with what is not said there; without a quantity where there is nothing to draw.
SweepPlot plot_of(const SweepScene& sweep, const SweepPart& members) {
  SweepPlot plot = sweep.plot;
  const std::vector<std::string> keys = sweep.design.columns();
  if (plot.x.empty() && keys.size() <= 2) {
    plot.x = keys[0];
    if (keys.size() == 2) plot.y = keys[1];
  }
  if (plot.x.empty()) return {};
  const auto take = [&](const auto& suits) {
    for (const Column& column : members.columns())
      if (plot.quantity.empty() && suits(column.name)) plot.quantity = column.name;
  };
  take([](const std::string& name) { return name == "run/cost"; });
  take([](const std::string& name) { return name.starts_with("final/") && name != "final/t"; });
  take([](const std::string&) { return true; });
  return plot;
}

std::string gnuplot_script(const SweepScene& sweep, const SweepPlot& plot) {
  const auto& keys = sweep.design.keys;
  const auto key = [&](const std::string& column) {
    const auto found = std::find_if(keys.begin(), keys.end(), [&](const auto& k) { return k.path == column; });
    return found == keys.end() ? Design::Key() : *found;
  };
  std::string out = "# Draws members.csv; run by lagroid, or by hand: gnuplot plot.gp\n";
  out += "set datafile separator ','\nset grid\nunset key\n";
  out += fmt::format("set xlabel {}\n", gnuplot_string(plot.x));
  if (key(plot.x).logarithmic) out += "set logscale x\n";
  if (key(plot.y).logarithmic) out += "set logscale y\n";
  std::string draw;
  if (plot.y.empty()) {
    out += fmt::format("set ylabel {}\n", gnuplot_string(plot.quantity));
    draw = fmt::format("plot 'members.csv' using (column({})):(column({})) with points pointtype 7 pointsize 0.4",
                       gnuplot_string(plot.x), gnuplot_string(plot.quantity));
  } else {
    const bool image = keys.size() == 2 && key(plot.x).equally_spaced && key(plot.y).equally_spaced;
    out += fmt::format("set ylabel {}\nset title {}\n", gnuplot_string(plot.y), gnuplot_string(plot.quantity));
    draw = fmt::format("plot 'members.csv' using (column({})):(column({})):(column({})) with {}",
                       gnuplot_string(plot.x), gnuplot_string(plot.y), gnuplot_string(plot.quantity),
                       image ? "image" : "points pointtype 7 pointsize 0.5 palette");
  }
  for (const auto& [file, terminal] : {std::pair("plot.svg", "svg size 720,560 background 'white' noenhanced"),
                                       std::pair("plot.png", "pngcairo size 720,560 noenhanced")})
    out += fmt::format("\nset terminal {}\nset output '{}'\n{}\nset output\n", terminal, file, draw);
  return out;
}

}  // namespace

long SweepResult::failed() const {
  return std::count_if(members.status().begin(), members.status().end(),
                       [](const std::string& status) { return status != "converged"; });
}

std::string sweep_text(const SweepScene& sweep, const SweepResult& result) {
  const SweepPart& members = result.members;
  std::string counted;
  for (const auto& [status, count] : statuses(members))
    counted += fmt::format("{}{} {}", counted.empty() ? "" : ", ", count, status);
  std::string out = fmt::format("{}: {} members: {}\n", sweep.file, members.count(), counted);
  out += fmt::format("  design    {} over {}\n", sweep.design.kind, fmt::join(sweep.design.columns(), ", "));
  out += fmt::format("  engine    {}\n", result.engine);
  for (const std::string& note : sweep.notes) out += fmt::format("  note: {}\n", note);
  std::size_t told = 0;
  for (const auto& [member, message] : members.messages()) {
    if (told++ == most_failures_told) break;
    out += fmt::format("  member {}: {}: {}\n", member, members.status()[std::size_t(member)], message);
  }
  if (const long more = long(members.messages().size()) - long(most_failures_told); more > 0)
    out += fmt::format("  and {} more that failed; their messages are in sweep.h5\n", more);
  out += fmt::format("  {:<32} {:>14} {:>14} {:>14}\n", "", "least", "mean", "largest");
  for (const Column& column : members.columns())
    if (const Range range = range_of(column.values); range.count > 0)
      out +=
          fmt::format("  {:<32} {:>14.6g} {:>14.6g} {:>14.6g}\n", column.name, range.least, range.mean, range.largest);
  return out;
}

OrderedJson sweep_json(const SweepScene& sweep, const SweepResult& result) {
  const SweepPart& members = result.members;
  OrderedJson out;
  out["status"] = result.failed() == 0 ? "converged" : "members_failed";
  if (result.failed() > 0) out["message"] = fmt::format("{} of {} members failed", result.failed(), members.count());
  out["members"] = members.count();
  out["failed"] = result.failed();
  out["statuses"] = statuses(members);
  out["design"] = {{"kind", sweep.design.kind}, {"keys", sweep.design.columns()}};
  out["engine"] = result.engine;
  out["notes"] = sweep.notes;
  OrderedJson failures = OrderedJson::array();
  for (const auto& [member, message] : members.messages()) {
    if (failures.size() == most_failures_told) break;
    failures.push_back({{"member", member}, {"status", members.status()[std::size_t(member)]}, {"message", message}});
  }
  out["failures"] = failures;
  OrderedJson columns = OrderedJson::object();
  for (const Column& column : members.columns())
    if (const Range range = range_of(column.values); range.count > 0)
      columns[column.name] = {{"least", range.least}, {"mean", range.mean}, {"largest", range.largest}};
  out["columns"] = columns;
  return out;
}

std::vector<fs::path> write_sweep(const SweepScene& sweep, const SweepResult& result, const fs::path& folder,
                                  std::string& note) {
  Drawing drawing;
  const auto make = [&](const fs::path& staging) {
    const SweepPart& members = result.members;
    std::vector<std::string> names{"sweep.h5", "summary.json", "summary.txt"};
    write_data(sweep, result, staging / "sweep.h5");
    write_text(json_text(sweep_json(sweep, result)) + "\n", staging / "summary.json");
    write_text(visible(sweep_text(sweep, result), "\n"), staging / "summary.txt");
    const std::size_t width = sweep.design.width() + members.columns().size() + 2;
    if (members.status().size() > most_cells_in_csv / width) return names;
    write_csv(sweep, members, staging / "members.csv");
    names.emplace_back("members.csv");
    const SweepPlot plot = plot_of(sweep, members);
    if (plot.quantity.empty() || members.count() > most_points_in_picture) return names;
    write_text(gnuplot_script(sweep, plot), staging / "plot.gp");
    names.emplace_back("plot.gp");
    drawing = {"plot.gp", {"plot.svg", "plot.png"}};
    return names;
  };
  return write_and_draw(folder, sweep_files, make, drawing, note);
}

}  // namespace lagroid::app
