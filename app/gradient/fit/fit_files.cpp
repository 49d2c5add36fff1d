#include "fit_files.hpp"

#include <lagroid/run/reports/gnuplot.hpp>
#include <lagroid/run/reports/text.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstddef>

namespace lagroid::app {

namespace {

constexpr std::array<const char*, 6> files{"residuals.csv", "summary.json", "summary.txt",
                                           "figures.gp",    "plot.svg",     "plot.png"};

/// A panel for each column: points are measured, lines are the fitted runs between their times.
std::string gnuplot_script(const Fit& fit) {
  constexpr std::size_t most_panels = 8;
  const std::size_t panels = std::min(most_panels, fit.columns.size());
  std::string out =
      "# Draws what was measured and what the fitted runs have there; run by lagroid, or by hand: gnuplot figures.gp\n"
      "set grid\nset key outside right noenhanced\nset xlabel 't'\nset lmargin 12\nset rmargin 22\n";
  std::string panel;
  for (std::size_t c = 0; c < panels; ++c) {
    std::string curves;
    for (std::size_t run = 0; run < fit.runs; ++run) {
      std::string rows;
      for (const Fit::Point& each : fit.points)
        if (each.run == run && each.column == c)
          rows += fmt::format("{:.17g} {:.17g} {:.17g}\n", each.time, each.measured, each.predicted);
      if (rows.empty()) continue;
      const std::string block = fmt::format("$of_{}_{}", run + 1, c + 1);
      out += fmt::format("{} << EOD\n{}EOD\n", block, rows);
      const std::string of_run = fit.runs > 1 ? fmt::format(", run {}", run + 1) : "";
      curves += fmt::format(
          "{}{} using 1:2 with points pointtype 7 pointsize 0.4 linetype {} title {}, {} using 1:3 with lines linetype "
          "{} title {}",
          curves.empty() ? "" : ", ", block, run + 1, gnuplot_string("measured" + of_run), block, run + 1,
          gnuplot_string("fitted" + of_run));
    }
    if (!curves.empty()) panel += fmt::format("set title {}\nplot {}\n", gnuplot_string(fit.columns[c].name), curves);
  }
  const std::size_t height = 60 + 260 * panels;
  for (const auto& [file, terminal] :
       {std::pair("plot.svg", fmt::format("svg size 900,{} background 'white' noenhanced", height)),
        std::pair("plot.png", fmt::format("pngcairo size 900,{} noenhanced", height))})
    out += fmt::format("\nset terminal {}\nset output '{}'\nset multiplot layout {},1\n{}unset multiplot\nset output\n",
                       terminal, file, panels, panel);
  return out;
}

}  // namespace

OutputFolder folder_for_fit(const std::filesystem::path& folder, const Section& scene,
                            const std::vector<std::string>& data) {
  return {folder, OutputKind::report,
          OutputSource{{"scene", scene.whole()}, {"data", fmt::format("{}", fmt::join(data, "\n"))}}, files};
}

std::vector<std::filesystem::path> write_fit(const Fit& fit, const std::filesystem::path& folder, std::string& note) {
  const auto make = [&](const std::filesystem::path& staging) {
    write_text(csv_of(fit), staging / "residuals.csv");
    write_text(json_of(fit) + "\n", staging / "summary.json");
    write_text(visible(text_of(fit), "\n"), staging / "summary.txt");
    write_text(gnuplot_script(fit), staging / "figures.gp");
    return std::vector<std::string>{"residuals.csv", "summary.json", "summary.txt", "figures.gp"};
  };
  return write_and_draw(folder, files, make, {"figures.gp", {"plot.svg", "plot.png"}}, note);
}

}  // namespace lagroid::app
