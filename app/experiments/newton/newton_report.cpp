#include "newton_report.hpp"

#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/solvers/step/arclength.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

namespace lagroid::app {

const std::vector<const char*> newton_report_files{"report.md",  "tables.md",  "cells.csv",      "grid.csv",
                                                   "times.csv",  "figures.gp", "figure_5_1.svg", "figure_5_2.svg",
                                                   "solved.svg", "time.svg"};

namespace {

using Cells = std::vector<const NewtonCell*>;

/// Those of the figures.
constexpr NewtonMethod shown_methods[] = {NewtonMethod::fixed_point, NewtonMethod::version1, NewtonMethod::version2,
                                          NewtonMethod::path};

/// The cells of one method, for every N and h or for one.
Cells select(const NewtonFindings& f, NewtonExample example, NewtonMethod method, std::optional<int> n = {},
             std::optional<int> log2h = {}) {
  Cells out;
  for (const auto& c : f.cells)
    if (c.example == example && c.method == method && c.n == n.value_or(c.n) && c.log2h == log2h.value_or(c.log2h))
      out.push_back(&c);
  return out;
}

/// The p-quantile, NaN of nothing.
double quantile(std::vector<double> x, double p) {
  if (x.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto at = x.begin() + std::ptrdiff_t(p * double(x.size() - 1) + 0.5);
  std::nth_element(x.begin(), at, x.end());
  return *at;
}

std::ptrdiff_t count(const Cells& cells, bool NewtonCell::*property) {
  return std::count_if(cells.begin(), cells.end(), [&](const NewtonCell* c) { return c->*property; });
}
double share(const Cells& cells, bool NewtonCell::*property) {
  return cells.empty() ? 0 : double(count(cells, property)) / double(cells.size());
}

template <class Get> std::vector<double> values(const Cells& cells, const Get& get) {
  std::vector<double> out;
  for (const NewtonCell* c : cells)
    if (const std::optional<double> x = get(*c); x && std::isfinite(*x)) out.push_back(*x);
  return out;
}

/// The median number of iterations of those that converged, NaN where fewer than half did.
double median_iterations(const Cells& cells) {
  if (share(cells, &NewtonCell::converged) < 0.5) return std::numeric_limits<double>::quiet_NaN();
  return quantile(
      values(cells,
             [](const NewtonCell& c) { return c.converged ? std::optional<double>(c.iterations) : std::nullopt; }),
      0.5);
}

std::optional<double> order_of(const NewtonCell& c) { return c.order; }

/// One row of a Markdown table.
std::string row(const std::vector<std::string>& entries) {
  std::string out = "|";
  for (const auto& e : entries) out += " " + e + " |";
  return out + "\n";
}
std::string header(const std::vector<std::string>& entries) {
  std::string out = row(entries) + "|";
  for (std::size_t i = 0; i < entries.size(); ++i) out += "---|";
  return out + "\n";
}

std::vector<int> sizes(const NewtonFindings& f) {
  std::vector<int> out;
  for (int n = f.study.smallest; n <= f.study.largest; ++n) out.push_back(n);
  return out;
}

std::string solved_table(const NewtonFindings& f, NewtonExample example) {
  std::vector<std::string> head{"N"};
  for (const auto method : newton_methods) head.push_back(name_of(method));
  std::string out = header(head);
  const auto line = [&](const std::string& name, std::optional<int> n) {
    std::vector<std::string> entries{name};
    for (const auto method : newton_methods) {
      const double s = solved_share(f, example, method, n);
      entries.push_back(fmt::format("{:.{}f} %", 100 * s, s > 0.985 && s < 1 ? 2 : 0));
    }
    out += row(entries);
  };
  for (const int n : sizes(f)) line(std::to_string(n), n);
  line("all", std::nullopt);
  return out;
}

/// How many solved steps have a solution beyond the logarithm, for the methods that can find such.
std::string beyond_table(const NewtonFindings& f) {
  constexpr NewtonMethod free[] = {NewtonMethod::fixed_point, NewtonMethod::version2, NewtonMethod::damped2,
                                   NewtonMethod::ceres, NewtonMethod::path};
  std::vector<std::string> head{"N"};
  for (const auto example : newton_examples)
    for (const auto method : free) head.push_back(fmt::format("{}: {}", number_of(example), name_of(method)));
  std::string out = header(head);
  for (const int n : sizes(f)) {
    std::vector<std::string> entries{std::to_string(n)};
    for (const auto example : newton_examples)
      for (const auto method : free) {
        const Cells cells = select(f, example, method, n);
        entries.push_back(
            fmt::format("{} of {}", count(cells, &NewtonCell::beyond), count(cells, &NewtonCell::solved)));
      }
    out += row(entries);
  }
  return out;
}

std::string cost_table(const NewtonFindings& f) {
  std::string out = header({"example", "N", "plain Newton alone", "median", "90 %", "most"});
  for (const auto example : newton_examples)
    for (const int n : sizes(f)) {
      const Cells cells = select(f, example, NewtonMethod::path, n);
      const auto cost = values(cells, [](const NewtonCell& c) { return std::optional<double>(c.factorisations); });
      out += row({std::to_string(number_of(example)), std::to_string(n),
                  fmt::format("{:.0f} %", 100 * share(cells, &NewtonCell::plain)),
                  fmt::format("{:.0f}", quantile(cost, 0.5)), fmt::format("{:.0f}", quantile(cost, 0.9)),
                  fmt::format("{:.0f}", quantile(cost, 1))});
    }
  return out;
}

std::string order_table(const NewtonFindings& f) {
  std::string out = header({"example", "iteration", "steps", "lower quartile", "median", "upper quartile"});
  for (const auto example : newton_examples)
    for (const auto method : {NewtonMethod::fixed_point, NewtonMethod::version1, NewtonMethod::version2}) {
      const auto orders = values(select(f, example, method), [](const NewtonCell& c) {
        return c.log2h <= 0 ? std::optional(c.order) : std::nullopt;  // the tolerance is above round-off
      });
      out += row({std::to_string(number_of(example)), name_of(method), std::to_string(orders.size()),
                  fmt::format("{:.2f}", quantile(orders, 0.25)), fmt::format("{:.2f}", quantile(orders, 0.5)),
                  fmt::format("{:.2f}", quantile(orders, 0.75))});
    }
  return out;
}

constexpr int fit_from = 6;
constexpr int fit_to = 15;

/// The slope of log(time) over log(N) by least squares between two N; NaN of fewer than two times.
double slope(const std::vector<IterationTime>& times, double IterationTime::*time, int from, int to) {
  double count = 0;
  double sx = 0;
  double sy = 0;
  double sxx = 0;
  double sxy = 0;
  for (const auto& t : times) {
    if (t.n < from || t.n > to || !(t.*time > 0)) continue;
    const double x = std::log(t.n);
    const double y = std::log(t.*time);
    count += 1;
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  if (count < 2) return std::numeric_limits<double>::quiet_NaN();
  return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

constexpr std::pair<const char*, double IterationTime::*> clocks[] = {
    {"fixed point", &IterationTime::fixed_point},
    {"version 1 exact", &IterationTime::version1},
    {"version 2 exact", &IterationTime::version2},
    {"version 1 finite differences", &IterationTime::version1_quotients},
    {"version 2 finite differences", &IterationTime::version2_quotients}};

std::string time_table(const NewtonFindings& f) {
  std::vector<std::string> head{"N", "unknowns"};
  for (const auto& [name, time] : clocks) head.emplace_back(name);
  head.emplace_back("finite differences / exact");
  std::string out = header(head);
  const auto micro = [](double s) { return s > 0 ? fmt::format("{:.3g}", 1e6 * s) : std::string("-"); };
  for (const auto& t : f.times) {
    std::vector<std::string> entries{std::to_string(t.n), std::to_string(t.n * (t.n - 1) / 2)};
    for (const auto& [name, time] : clocks) entries.push_back(micro(t.*time));
    entries.push_back(t.version1_quotients > 0 ? fmt::format("{:.1f}, {:.1f}", t.version1_quotients / t.version1,
                                                             t.version2_quotients / t.version2)
                                               : "-");
    out += row(entries);
  }
  const auto slopes = [&](int from, int to) {
    std::vector<std::string> entries{fmt::format("exponent, N = {} to {}", from, to), ""};
    for (const auto& [name, time] : clocks) {
      const double exponent = slope(f.times, time, from, to);
      entries.push_back(std::isfinite(exponent) ? fmt::format("{:.1f}", exponent) : "-");
    }
    entries.emplace_back("");
    return row(entries);
  };
  return out + slopes(fit_from, fit_to) + slopes(20, 30);
}

std::string integrator_table(const NewtonFindings& f) {
  if (f.integrators.empty()) return "";
  std::vector<std::string> head{"problem", "method", "declared order"};
  for (const int steps : f.integrators.front().steps) head.push_back(fmt::format("error, {} steps", steps));
  head.emplace_back("observed order");
  std::string out = header(head);
  for (const auto& e : f.integrators) {
    std::vector<std::string> entries{e.problem, e.method, std::to_string(e.declared_order)};
    for (const double error : e.errors) entries.push_back(fmt::format("{:.2e}", error));
    const std::size_t last = e.errors.size() - 1;
    entries.push_back(fmt::format("{:.2f}", std::log2(e.errors[last - 1] / e.errors[last])));
    out += row(entries);
  }
  return out;
}

std::string tables(const NewtonFindings& f) {
  std::string out =
      "<!-- Written by the command below. -->\n# Iterations, step by step\n\n`" + f.command +
      "`\n\nMedian number of iterations over the seeds, of those that converged; `-` where fewer than half did. For "
      "\"Newton and path\" the number of Jacobians factorised.\n";
  for (const auto example : newton_examples)
    for (const auto method : shown_methods) {
      out += fmt::format("\n## Example {}, {}\n\n", number_of(example), name_of(method));
      std::vector<std::string> head{"log2 h"};
      for (const int n : sizes(f)) head.push_back(fmt::format("N = {}", n));
      out += header(head);
      for (int log2h = least_log2h; log2h <= most_log2h; ++log2h) {
        std::vector<std::string> entries{std::to_string(log2h)};
        for (const int n : sizes(f)) {
          const double median = median_iterations(select(f, example, method, n, log2h));
          entries.push_back(std::isfinite(median) ? fmt::format("{:.0f}", median) : "-");
        }
        out += row(entries);
      }
    }
  return out;
}

std::string cells_csv(const NewtonFindings& f) {
  std::string out =
      "example,method,N,seed,log2h,status,converged,solved,iterations,residual,order,factorisations,beyond_log\n";
  for (const auto& c : f.cells)
    out += fmt::format("{},{},{},{},{},{},{},{},{},{:.6g},{:.6g},{},{}\n", number_of(c.example), name_of(c.method), c.n,
                       c.seed, c.log2h, c.status, int(c.converged), int(c.solved), c.iterations, c.residual, c.order,
                       c.factorisations, int(c.beyond));
  return out;
}

/// What the figures show: medians over the seeds.
std::string grid_csv(const NewtonFindings& f) {
  std::string out = "example,method,N,log2h,iterations,order,solved,beyond\n";
  for (const auto example : newton_examples)
    for (const auto method : newton_methods)
      for (const int n : sizes(f))
        for (int log2h = least_log2h; log2h <= most_log2h; ++log2h) {
          const Cells cells = select(f, example, method, n, log2h);
          out += fmt::format("{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g}\n", number_of(example), name_of(method), n, log2h,
                             median_iterations(cells), quantile(values(cells, order_of), 0.5),
                             share(cells, &NewtonCell::solved), share(cells, &NewtonCell::beyond));
        }
  return out;
}

std::string times_csv(const NewtonFindings& f) {
  std::string out = "N";
  for (const auto& [name, time] : clocks) out += fmt::format(",{}", name);
  out += "\n";
  for (const auto& t : f.times) {
    out += std::to_string(t.n);
    for (const auto& [name, time] : clocks) out += t.*time > 0 ? fmt::format(",{:.6g}", t.*time) : std::string(",");
    out += "\n";
  }
  return out;
}

std::string figures(const NewtonFindings& f) {
  const int first = f.study.smallest;
  const int last = f.study.largest;
  std::string out =
      "# Draws the figures of report.md: gnuplot figures.gp\nset datafile separator ','\nset datafile missing 'nan'\n"
      "set xtics 2\nset grid\n";
  const auto cells = [](int example, NewtonMethod method, const std::string& value, const std::string& also = "1") {
    return fmt::format("(column('example')=={} && strcol('method') eq '{}' && ({}) ? column('{}') : NaN)", example,
                       name_of(method), also, value);
  };
  const auto shaded = [&](int example, NewtonMethod method, const std::string& value) {
    return fmt::format(
        "'grid.csv' using (column('log2h')):{}:(column('{}')) with points pointtype 5 pointsize 1.4 linecolor palette "
        "z\n",
        cells(example, method, "N"), value);
  };
  std::vector<int> curves;  // at most six
  for (int n = first; n <= last; n += 1 + (last - first) / 6) curves.push_back(n);
  for (const auto example : newton_examples) {
    const int number = number_of(example);
    out += fmt::format(
        "\nset terminal svg size 1200,1280 background 'white' noenhanced font ',11'\nset output 'figure_5_{}.svg'\n"
        "set multiplot layout 4,3\nset palette defined (0 '#ffffcc', 0.5 '#41b6c4', 1 '#0c2c84')\n",
        number);
    for (const auto method : shown_methods) {
      const bool ours = method == NewtonMethod::path;
      const std::string unit = ours ? "Jacobians" : "iterations";
      // Left: over h and N.
      out += fmt::format(
          "unset key\nunset logscale\nset xlabel 'log2 h'\nset ylabel 'N'\nset title '{}: {}'\nset xrange [{}:{}]\n"
          "set yrange [{}:{}]\nset logscale cb\nset cbrange [1:{}]\n"
          "plot {}",
          name_of(method), unit, least_log2h - 1, most_log2h + 1, first - 1, last + 1, ours ? 10000 : 100,
          shaded(number, method, "iterations"));
      // Centre: over h.
      out += fmt::format(
          "set key top left\nset ylabel '{}'\nset logscale y\nset yrange [1:{}]\nset title '{}: {} for some N'\nplot ",
          unit, ours ? 100000 : 200, name_of(method), unit);
      for (std::size_t i = 0; i < curves.size(); ++i)
        out += fmt::format(
            "{}'grid.csv' using (column('log2h')):{} with linespoints pointtype 7 pointsize 0.4 title 'N = {}'",
            i ? ", " : "", cells(number, method, "iterations", fmt::format("column('N')=={}", curves[i])), curves[i]);
      // Right: observed order, or where solutions lie.
      if (ours) {
        out += "\nunset key\nunset logscale\nset ylabel 'N'\n" +
               fmt::format("set yrange [{}:{}]\nset cbrange [0:1]\nset title 'share beyond the logarithm'\n", first - 1,
                           last + 1) +
               "plot " + shaded(number, method, "beyond");
      } else {
        out += fmt::format(
            "\nunset key\nunset logscale\nset ylabel 'order'\nset yrange [0:3]\nset title '{}: observed order'\n"
            "plot 'grid.csv' using (column('log2h')):{} with points pointtype 7 pointsize 0.5\n",
            name_of(method), cells(number, method, "order"));
      }
    }
    out += "unset multiplot\n";
  }
  out +=
      "\nset terminal svg size 1000,520 background 'white' noenhanced\nset output 'solved.svg'\n"
      "set multiplot layout 1,2\nunset logscale\nset yrange [0:1.05]\nset xtics auto\nset key below\n"
      "set xlabel 'N'\nset ylabel 'share of the steps h = 2^-10 .. 2^10 solved'\n" +
      fmt::format("set xrange [{}:{}]\n", first - 0.5, last + 0.5);
  for (const auto example : newton_examples) {
    out += fmt::format("set title 'example {}'\nplot ", number_of(example));
    for (std::size_t i = 0; i < std::size(newton_methods); ++i) {
      out += fmt::format("{}'-' using 1:2 with linespoints pointtype 7 pointsize 0.5 title '{}'", i ? ", " : "",
                         name_of(newton_methods[i]));
    }
    out += "\n";
    for (const auto method : newton_methods) {
      for (const int n : sizes(f)) out += fmt::format("{},{:.6g}\n", n, solved_share(f, example, method, n));
      out += "e\n";
    }
  }
  out += "unset multiplot\n";
  if (!f.times.empty()) {
    out +=
        "\nset terminal svg size 640,560 background 'white' noenhanced\nset output 'time.svg'\nset logscale xy\nset "
        "format y '%.0e'\n"
        "set xrange [1.8:35]\nset yrange [*:*]\nset xtics (2,3,5,10,15,20,30)\nset key below\n"
        "set title 'example 1, h = 0.1'\nset xlabel 'N'\nset ylabel 'seconds for one iteration'\nplot ";
    bool comma = false;
    for (const auto& [name, time] : clocks) {
      out += fmt::format("{}'times.csv' using 'N':'{}' with linespoints pointtype 7 pointsize 0.5 title '{}'",
                         comma ? ", " : "", name, name);
      comma = true;
    }
    out += "\n";
  }
  return out;
}

std::string report(const NewtonFindings& f, bool pictures) {
  const auto picture = [&](const char* file, const char* what) {
    return pictures ? fmt::format("![{}]({})\n", what, file) : fmt::format("({}: no picture was drawn)\n", file);
  };
  const std::size_t starts = std::size_t(2 * f.study.seeds) * sizes(f).size();
  std::string out = fmt::format(
      "<!-- Written by the command below. -->\n"
      "# The Newton iteration on Lie groups\n\n"
      "Written, with its figures, by\n\n    {}\n\n"
      "Section 5 of Owren and Welfert, *The Newton iteration on Lie groups* (BIT 40, 2000), and what lies beyond it. "
      "One implicit Euler step y = z exp(h g(y)) on O(N) is solved for N = {} to {}, h = 2^-10 to 2^10, and {} random "
      "z "
      "for each N and each of the two fields g: {} steps in all. Every single one is a line of `cells.csv`; "
      "[tables.md](tables.md) has the medians.\n\n"
      "The paper iterates from y = z, at most {} times, until |v - h g(y)| (spectral norm) is at most 1e-13. For large "
      "h "
      "that is below the round-off of h g(y), and whether an iteration meets it is chance; so *solved* means below "
      "|v - h g(y)| <= 1e-13 (1 + h), at any iterate.\n\n",
      f.command, f.study.smallest, f.study.largest, f.study.seeds, starts * std::size_t(most_log2h - least_log2h + 1),
      paper_iterations);
  out +=
      "## Figures 5.1 and 5.2\n\n"
      "From top to bottom: the paper's three iterations, then ours. Blank: fewer than half of the random z "
      "converged.\n\n";
  out += picture("figure_5_1.svg", "Figure 5.1: example 1") + "\n";
  out += picture("figure_5_2.svg", "Figure 5.2: example 2") + "\n";
  out +=
      "The paper reports that version 1 converges for larger steps than version 2 while N is small, that the "
      "fixed-point iteration does for small steps alone, and that for larger N the versions lose their advantage.\n\n";
  out += fmt::format(
      "## What is solved\n\n"
      "*Newton and path* is `solve_implicit_step`: version 1 for at most {} iterations, then pseudo-arclength "
      "continuation of v = h g(z exp v) from h = 0, h = sinh(s). *Damped* halves an update until |f| falls, at most {} "
      "times, then refuses. *Ceres* is Levenberg-Marquardt in the coordinates v, at most {} iterations.\n\n",
      ArclengthOptions{}.plain_iterations, damping_halvings, ceres_iterations);
  for (const auto example : newton_examples)
    out += fmt::format("**Example {}**\n\n{}\n", number_of(example), solved_table(f, example));
  out += picture("solved.svg", "share of steps solved") + "\n";
  out +=
      "Solutions beyond the principal logarithm (a spectral radius of v above pi) solve the step, but no iteration "
      "that takes logarithms can find them. Among the steps solved, by example and method:\n\n" +
      beyond_table(f) + "\n";
  out +=
      "## What it costs\n\n"
      "Jacobians factorised by *Newton and path* for one step, the plain iterations before the path and every "
      "corrector along it included:\n\n" +
      cost_table(f) + "\n";
  out +=
      "## Order of convergence\n\n"
      "The paper's ratio of logarithms of the last residuals, over the steps h <= 1 that converged in three or more "
      "iterations. (`tests/solvers/lie_newton/orders.cpp` shows the quadratic decay run by run in extended "
      "precision.)\n\n" +
      order_table(f) + "\n";
  if (!f.times.empty()) {
    out +=
        "## Time for one iteration\n\n"
        "Microseconds, example 1, h = 0.1. The exact differential multiplies, in the basis of the real Schur form of "
        "v, "
        "2 x 2 blocks by exp(-i d) sin(d) / d; finite differences take one exponential, and in version 1 one "
        "logarithm, for each unknown.\n\n" +
        time_table(f) + "\n" + picture("time.svg", "time for one iteration over N") + "\n";
  }
  if (!f.integrators.empty())
    out +=
        "## Implicit integrators\n\n"
        "Diagonally implicit Crouch-Grossman methods (section 6 of the paper), their stages solved by "
        "`solve_implicit_step`. On the sphere the iteration runs on the source fibre of the action groupoid of SO(3): "
        "the arrow has coordinates where the point has none that are natural.\n\n" +
        integrator_table(f);
  return out;
}

}  // namespace

double solved_share(const NewtonFindings& f, NewtonExample example, NewtonMethod method, std::optional<int> n) {
  return share(select(f, example, method, n), &NewtonCell::solved);
}

std::vector<std::filesystem::path> write_newton_report(const NewtonFindings& f, const std::filesystem::path& folder,
                                                       std::string& note) {
  Drawing drawing{"figures.gp", {"figure_5_1.svg", "figure_5_2.svg", "solved.svg"}};
  if (!f.times.empty()) drawing.pictures.emplace_back("time.svg");
  const auto data = [&](const std::filesystem::path& staging) {
    std::vector<std::string> names{"tables.md", "cells.csv", "grid.csv", "figures.gp"};
    write_text(cells_csv(f), staging / "cells.csv");
    write_text(grid_csv(f), staging / "grid.csv");
    if (!f.times.empty()) {
      write_text(times_csv(f), staging / "times.csv");
      names.emplace_back("times.csv");
    }
    write_text(figures(f), staging / "figures.gp");
    write_text(tables(f), staging / "tables.md");
    return names;
  };
  return write_and_draw(folder, newton_report_files, data, drawing, note,
                        [&](const std::filesystem::path& staging, bool drawn) {
                          write_text(report(f, drawn), staging / "report.md");
                          return std::vector<std::string>{"report.md"};
                        });
}

}  // namespace lagroid::app
