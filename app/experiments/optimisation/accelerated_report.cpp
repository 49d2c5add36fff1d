#include "accelerated_report.hpp"

#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/run/machine.hpp>
#include <lagroid/run/reports/clock.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace lagroid::app {

const std::vector<const char*> accelerated_report_files{"report.md",  "runs.csv",     "curves.csv", "costs.csv",
                                                        "figures.gp", "figure_1.svg", "tuned.svg",  "costs.svg"};

namespace {

std::string runs_csv(const AcceleratedFindings& findings) {
  std::string out =
      "problem,method,seed,outcome,gap,iterations_8,evaluations_8,seconds_8,iterations_12,evaluations_12,seconds_12\n";
  for (const auto& r : findings.runs)
    fmt::format_to(std::back_inserter(out), "{},{},{},{},{:.3g},{},{},{:.3g},{},{},{:.3g}\n", r.problem, r.method,
                   r.seed, r.outcome, r.gap, r.to_8.iterations, r.to_8.evaluations, r.to_8.seconds, r.to_12.iterations,
                   r.to_12.evaluations, r.to_12.seconds);
  return out;
}

std::string curves_csv(const AcceleratedFindings& findings) {
  std::string out = "problem,method,iteration,gap\n";
  for (const auto& p : findings.points)
    fmt::format_to(std::back_inserter(out), "{},{},{},{:.4g}\n", p.problem, p.method, p.iteration, p.gap);
  return out;
}

std::string costs_csv(const AcceleratedFindings& findings) {
  std::string out = "n,m,gradient,ours,descent,multipliers,qr\n";
  for (const auto& c : findings.costs)
    fmt::format_to(std::back_inserter(out), "{},{},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g}\n", c.n, c.m, c.gradient, c.ours,
                   c.descent, c.multipliers, c.qr);
  return out;
}

/// Four panels: f above its minimum over iterations, by the methods whose kind `wanted` accepts.
template <class Wanted> std::string curves_figure(const char* file, const Wanted& wanted) {
  std::string out = fmt::format(
      "set terminal svg size 1040,1200 background 'white' noenhanced\nset output '{}'\nset multiplot layout 2,2\n"
      "set logscale xy\nset format y '%.0e'\nset yrange [1e-14:*]\nset xlabel 'iteration'\nset key below\n",
      file);
  for (const std::string& problem : accelerated_problems()) {
    out += fmt::format("set title '{}: f above its minimum'\nplot ", problem);
    bool first = true;
    for (const auto& method : accelerated_methods()) {
      if (!wanted(method)) continue;
      out += fmt::format(
          "{}'curves.csv' using (column('iteration') + 1):((strcol('problem') eq '{}') && (strcol('method') eq '{}') "
          "&& "
          "(column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5 {} title '{}'",
          first ? "" : ", \\\n  ", problem, method.name, method.kind == "uncapped" ? "dashtype 2" : "", method.name);
      first = false;
    }
    out += "\n";
  }
  return out + "unset multiplot\nset output\nunset logscale\nset yrange [*:*]\n\n";
}

std::string accelerated_figures() {
  std::string out =
      "# Draws curves.csv and costs.csv; run by lagroid, or by hand: gnuplot figures.gp\nset datafile separator ','\n"
      "set grid\n\n";
  out += curves_figure("figure_1.svg", [](const AcceleratedMethod& m) { return m.kind != "tuned"; });
  out += curves_figure(
      "tuned.svg", [](const AcceleratedMethod& m) { return m.kind == "tuned" || m.name == "Algorithm 1 adaptive"; });
  out +=
      "set terminal svg size 1040,500 background 'white' noenhanced\nset output 'costs.svg'\nset multiplot layout 1,2\n"
      "set logscale xy\nset ylabel 's of an iteration, without the gradient of f'\nset key below\n";
  for (const auto& [along, other, value] : {std::tuple("n", "m", 20), std::tuple("m", "n", 2000)}) {
    out += fmt::format("set xlabel '{}'\nset title '{} = {}'\nplot ", along, other, value);
    bool first = true;
    for (const auto& [column, title] :
         {std::pair("ours", "Algorithm 1, robust"), std::pair("descent", "gradient descent, QR"),
          std::pair("multipliers", "step with multipliers alone"), std::pair("qr", "QR retraction alone")}) {
      out += fmt::format(
          "{}'costs.csv' using (column('{}') == {} ? column('{}') : NaN):'{}' smooth unique with linespoints pointtype "
          "7 "
          "pointsize 0.5 title '{}'",
          first ? "" : ", \\\n  ", other, value, along, column, title);
      first = false;
    }
    out += "\n";
  }
  return out + "unset multiplot\nset output\n";
}

std::string table(const AcceleratedFindings& findings, const std::string& problem) {
  std::string out =
      "| method | iterations to 1e-8 | to 1e-12 | evaluations to 1e-12 | time to 1e-12 | arrived at 1e-12 | at the end "
      "|\n"
      "|---|---|---|---|---|---|---|\n";
  for (const auto& method : accelerated_methods()) {
    const auto median = [&](const std::function<double(const AcceleratedRun&)>& count) {
      return median_of(findings, problem, method.name, count);
    };
    const auto shown = [](double count) { return count < 0 ? std::string("-") : fmt::format("{:.0f}", count); };
    const double seconds = median([](const auto& r) { return r.to_12.iterations < 0 ? -1 : r.to_12.seconds; });
    const auto arrived = std::count_if(findings.runs.begin(), findings.runs.end(), [&](const auto& r) {
      return r.problem == problem && r.method == method.name && r.to_12.iterations >= 0;
    });
    out += fmt::format(
        "| {} | {} | {} | {} | {} | {} of {} | {:.0e} |\n", method.name,
        shown(median([](const auto& r) { return double(r.to_8.iterations); })),
        shown(median([](const auto& r) { return double(r.to_12.iterations); })),
        shown(median([](const auto& r) { return r.to_12.iterations < 0 ? -1.0 : double(r.to_12.evaluations); })),
        seconds < 0 ? "-" : duration(seconds), arrived, findings.study.instances,
        median([](const auto& r) { return std::max(0.0, r.gap); }));
  }
  return out;
}

std::string report(const AcceleratedFindings& findings, const std::string& command, bool pictures) {
  std::string out = fmt::format(
      "# Accelerated optimisation: Figure 1, and the competition\n\nWritten by\n\n    {}\n\non {}.\n\n"
      "Duruisseaux and Leok compare four problems in their Figure 1, with p = 6 and h = 0.001; ours are random ones of "
      "the sizes below, {} instances each, medians. Algorithms 1 and 2 have their coefficient capped at s = 1 / L, "
      "where "
      "it is not said otherwise (p-ring = 2, t0 = 0.1, C = 1); *robust* and what follows it are tuned. Evaluations are "
      "those of f, of its gradient and of a Hessian times a vector, each as much as one. At most {} iterations; the "
      "last column is f above its minimum after the last. Where "
      "the minimum is not known (unbalanced Procrustes), it is the least that any method found; a method that ends in "
      "another local minimum has not arrived.\n",
      command, machine(), findings.study.instances, findings.study.iterations);
  if (pictures)
    out +=
        "\n![The paper's methods, with the cap and (dashed) without](figure_1.svg)\n\n"
        "![Tuned methods beside the paper's best](tuned.svg)\n";
  const std::vector<const char*> sizes{"n = 100, sphere", "n = 100, m = 5", "A 80 x 60, m = 5", "n = 30, O(n)"};
  for (std::size_t i = 0; i < accelerated_problems().size(); ++i)
    out += fmt::format("\n## {}\n\n{}.\n\n{}", accelerated_problems()[i], sizes[i],
                       table(findings, accelerated_problems()[i]));
  out +=
      "\n## What an iteration costs\n\nBrockett's function of a diagonal matrix, the gradient of f taken off: what "
      "remains is the manifold's. Least of several runs in turns.\n\n"
      "| n | m | Algorithm 1, robust | gradient descent, QR | ratio | step with multipliers | QR retraction |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const auto& c : findings.costs)
    out += fmt::format("| {} | {} | {} | {} | {:.2f} | {} | {} |\n", c.n, c.m, duration(c.ours), duration(c.descent),
                       c.ours / c.descent, duration(c.multipliers), duration(c.qr));
  if (pictures) out += "\n![Time of an iteration against n and m](costs.svg)\n";
  return out;
}

}  // namespace

std::vector<std::filesystem::path> write_accelerated_report(const AcceleratedFindings& findings,
                                                            const std::string& command,
                                                            const std::filesystem::path& folder, std::string& note) {
  const auto data = [&](const std::filesystem::path& staging) {
    write_text(runs_csv(findings), staging / "runs.csv");
    write_text(curves_csv(findings), staging / "curves.csv");
    write_text(costs_csv(findings), staging / "costs.csv");
    write_text(accelerated_figures(), staging / "figures.gp");
    return std::vector<std::string>{"runs.csv", "curves.csv", "costs.csv", "figures.gp"};
  };
  return write_and_draw(folder, accelerated_report_files, data,
                        {"figures.gp", {"figure_1.svg", "tuned.svg", "costs.svg"}}, note,
                        [&](const std::filesystem::path& staging, bool drawn) {
                          write_text(report(findings, command, drawn), staging / "report.md");
                          return std::vector<std::string>{"report.md"};
                        });
}

}  // namespace lagroid::app
