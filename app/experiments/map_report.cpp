#include "constrained_maps.hpp"

#include <lagroid/run/files/output_folder.hpp>

#include <fmt/format.h>

#include <iterator>

namespace lagroid::app {

const std::vector<const char*> map_report_files{"report.md", "errors.csv", "figures.gp", "errors.svg"};

namespace {

std::string errors_csv(const std::vector<MapMethod>& methods) {
  std::string out = "problem,method,steps,q,p,tangent\n";
  for (const auto& method : methods)
    for (const auto& e : method.errors)
      fmt::format_to(std::back_inserter(out), "{},{},{},{:.4g},{:.4g},{:.4g}\n", method.problem, method.name, e.steps,
                     e.q, e.p, e.tangent);
  return out;
}

/// A panel for each problem: the error in q over the number of steps.
std::string figures(const std::vector<MapMethod>& methods) {
  std::string out =
      "# Draws errors.csv; run by lagroid, or by hand: gnuplot figures.gp\nset datafile separator ','\nset grid\n"
      "set terminal svg size 1040,620 background 'white' noenhanced\nset output 'errors.svg'\nset multiplot layout "
      "1,2\n"
      "set logscale xy\nset format y '%.0e'\nset xlabel 'steps'\nset key below\n";
  for (std::size_t i = 0; i < methods.size();) {
    const std::string& problem = methods[i].problem;
    out += fmt::format("set title '{}: error in q'\nplot ", problem);
    for (bool first = true; i < methods.size() && methods[i].problem == problem; ++i, first = false)
      out += fmt::format(
          "{}'errors.csv' using (column('steps')):((strcol('problem') eq '{}') && (strcol('method') eq '{}') && "
          "(column('q') > 0) ? column('q') : NaN) with linespoints pointtype 7 pointsize 0.5 title '{}'",
          first ? "" : ", \\\n  ", problem, methods[i].name, methods[i].name);
    out += "\n";
  }
  return out + "unset multiplot\nset output\n";
}

std::string report(const std::vector<MapMethod>& methods, const std::string& command, bool pictures) {
  std::string out = fmt::format(
      "# Orders of constrained Hamiltonian maps\n\nWritten by\n\n    {}\n\n"
      "Errors after T = 2 (planar pendulum: T = 8) against the solution by Taylor's method of order 19, in q, in the "
      "momentum as the map has "
      "it, "
      "and in its tangent part; orders from the last two numbers of steps whose errors are above round-off. With "
      "multipliers at the nodes the order ends at two, whatever r and the quadrature; composing the projected "
      "symmetric "
      "map makes it four; without constraints it is min(r + 1, s) (Theorem 5.1). Why: docs/hamiltonian_maps.md.\n",
      command);
  if (pictures) out += "\n![errors in q over the number of steps](errors.svg)\n";
  std::string problem;
  for (const auto& method : methods) {
    if (method.problem != problem) {
      problem = method.problem;
      out += fmt::format(
          "\n## {}\n\n| method | order in q | in p | in tangent p | error in q, {} steps | {} steps | status |\n"
          "|---|---|---|---|---|---|---|\n",
          problem, method.errors.front().steps, method.errors.back().steps);
    }
    out += fmt::format("| {} | {:.2f} | {:.2f} | {:.2f} | {:.2e} | {:.2e} | {} |\n", method.name,
                       map_order(method, [](const auto& e) { return e.q; }),
                       map_order(method, [](const auto& e) { return e.p; }),
                       map_order(method, [](const auto& e) { return e.tangent; }), method.errors.front().q,
                       method.errors.back().q, method.status);
  }
  return out;
}

}  // namespace

std::vector<std::filesystem::path> write_map_report(const std::vector<MapMethod>& methods, const std::string& command,
                                                    const std::filesystem::path& folder, std::string& note) {
  const auto data = [&](const std::filesystem::path& staging) {
    write_text(errors_csv(methods), staging / "errors.csv");
    write_text(figures(methods), staging / "figures.gp");
    return std::vector<std::string>{"errors.csv", "figures.gp"};
  };
  return write_and_draw(folder, map_report_files, data, {"figures.gp", {"errors.svg"}}, note,
                        [&](const std::filesystem::path& staging, bool drawn) {
                          write_text(report(methods, command, drawn), staging / "report.md");
                          return std::vector<std::string>{"report.md"};
                        });
}

}  // namespace lagroid::app
