#include <lagroid/run/study/findings/study_files.hpp>

#include <lagroid/run/study/findings/costs.hpp>
#include <lagroid/run/study/methods.hpp>

#include <lagroid/run/reports/clock.hpp>
#include <lagroid/run/reports/gnuplot.hpp>
#include <lagroid/run/reports/markup.hpp>
#include <lagroid/run/reports/text.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <tuple>

namespace lagroid {

namespace {

constexpr std::array study_files{"study.csv", "study.json", "study.md",  "study.gp",
                                 "study.svg", "study.png",  "study.html"};

using OrderedJson = nlohmann::ordered_json;

std::string cell(double x, const char* format = "{:.2g}") {
  return std::isfinite(x) ? fmt::format(fmt::runtime(format), x) : "";
}

const Method& method_of(const Findings& findings, const std::string& name) {
  return *std::find_if(findings.methods.begin(), findings.methods.end(),
                       [&](const Method& m) { return m.name == name; });
}

bool has(const Findings& findings, Axis axis) {
  return std::any_of(findings.runs.begin(), findings.runs.end(),
                     [&](const Measurement& m) { return is_point(m, axis) && error_of(m, axis) > 0; });
}

/// The errors, from a hundredth down, that the reference can tell apart from none.
std::vector<double> levels(const Findings& findings) {
  std::vector<double> out;
  for (int k = 2; k <= 14; ++k)
    if (const double level = std::pow(10.0, -k); level > 3 * findings.uncertainty) out.push_back(level);
  return out;
}

/// What [time] of the scene holds for that method.
std::string settings(const Findings& findings, const Cost& cost) {
  const long steps = std::max(1L, long(std::ceil(findings.end / cost.step)));
  return time_keys(method_of(findings, cost.method),
                   fmt::format("step = {:.9g}, steps = {}", findings.end / double(steps), steps));
}

std::string csv(const Findings& findings) {
  std::string out =
      "method,order,step,steps,evaluations,seconds,spread,repetitions,trajectory,invariants,constraint,energy_drift,"
      "energy_drift_error,status,message\n";
  for (const Measurement& m : findings.runs)
    out += fmt::format("{},{},{:.9g},{},{},{},{},{},{},{},{},{},{},{},{}\n", m.method, m.order, m.step, m.work.steps,
                       m.work.evaluations, cell(m.median(), "{:.4g}"), cell(m.spread()), m.seconds.size(),
                       cell(m.trajectory, "{:.4g}"), cell(m.invariants, "{:.4g}"), cell(m.constraint, "{:.4g}"),
                       cell(m.drift, "{:.4g}"), cell(m.drift_error, "{:.4g}"), m.status, in_csv(m.message));
  return out;
}

constexpr const char* failed_style = "pointtype 2 pointsize 0.8 linecolor 'black'";

/// How a method is drawn: strongly where it is the cheapest at some error, else pale.
struct Style {
  std::string strong, pale;
};

/// Of up to 120 methods no two share both colour and points, and of the first ten none its colour.
Style style_of(std::size_t method) {
  constexpr std::array colours{"1f77b4", "d62728", "2ca02c", "9467bd", "ff7f0e",
                               "17becf", "8c564b", "e377c2", "bcbd22", "556b8d"};
  constexpr std::array points{7, 5, 9, 13, 4, 6, 8, 12, 1, 3, 10, 11};  // 2 is that of failures
  const auto* colour = colours[method % colours.size()];
  const int point = points[(method + method / colours.size()) % points.size()];
  return {fmt::format("linecolor rgb '#{}' linewidth 2.2 pointtype {} pointsize 0.9", colour, point),
          fmt::format("linecolor rgb '#80{}' linewidth 1 pointtype {} pointsize 0.6", colour, point)};
}

/// What a panel draws: errors of an axis over a cost.
struct ErrorPanel {
  Axis axis;
  const char* column;
  const char* label;
  std::vector<std::string> cheapest;

  bool is_cheapest(const std::string& method) const {
    return std::find(cheapest.begin(), cheapest.end(), method) != cheapest.end();
  }
};

/// Two for each of the axes that something was measured on.
std::vector<ErrorPanel> error_panels(const Findings& findings) {
  std::vector<ErrorPanel> out;
  for (const Axis axis : axes) {
    if (!has(findings, axis)) continue;
    const double least = axis == Axis::trajectory ? std::max(3 * findings.uncertainty, 1e-15) : 1e-15;
    for (const auto& [column, label, cost] :
         {std::tuple("seconds", "time, s", &Cost::seconds), {"evaluations", "evaluations", &Cost::evaluations}})
      out.push_back({axis, column, label, cheapest_methods(findings.runs, axis, cost, least)});
  }
  return out;
}

/// The methods measured, first those that are the cheapest somewhere.
std::vector<std::string> cheapest_first(const Findings& findings, const std::vector<ErrorPanel>& panels) {
  auto out = methods_of(findings.runs);
  std::stable_partition(out.begin(), out.end(), [&](const std::string& method) {
    return std::any_of(panels.begin(), panels.end(), [&](const ErrorPanel& p) { return p.is_cheapest(method); });
  });
  return out;
}

std::string draw(const Findings& findings, const ErrorPanel& panel, const std::vector<std::string>& methods) {
  const char* error = name_of(panel.axis);
  double most = 0;
  for (const Measurement& m : findings.runs)
    if (is_point(m, panel.axis)) most = std::max(most, error_of(m, panel.axis));
  std::string out = fmt::format(
      "set xlabel '{}'\nset ylabel 'error: {}'\nset title {}\nplot ", panel.label, error,
      gnuplot_string(panel.axis == Axis::trajectory ? fmt::format("{}, state at t = {:g}", findings.name, findings.end)
                                                    : fmt::format("{}, worst at any node", findings.name)));
  for (const bool strong : {false, true})  // above the others
    for (std::size_t i = 0; i < methods.size(); ++i) {
      if (panel.is_cheapest(methods[i]) != strong) continue;
      const Style style = style_of(i);
      out += fmt::format(
          "'study.csv' using (column('{0}')):((strcol('method') eq '{1}') && (strcol('status') eq 'converged') && "
          "(column('{2}') > 0) && (column('{2}') <= 1) ? column('{2}') : NaN) with linespoints {3}, ",
          panel.column, methods[i], error, strong ? style.strong : style.pale);
    }
  return out + fmt::format(
                   "'study.csv' using (column('{0}')):((strcol('status') ne 'converged') || (column('{1}') > 1) ? "
                   "{2:.3g} : NaN) with points {3}\n",
                   panel.column, error, 3 * most, failed_style);
}

std::string figure(const Findings& findings) {
  std::string out = "# Draws study.csv; run by lagroid, or by hand: gnuplot study.gp\nset datafile separator ','\n";
  const auto panels = error_panels(findings);
  const auto methods = cheapest_first(findings, panels);
  const std::size_t rows = panels.size() / 2;
  const std::pair<const char*, std::string> terminals[] = {
      {"study.svg", "svg size 1400,{} background 'white' noenhanced font ',11'"},
      {"study.png", "pngcairo size 1400,{} noenhanced"}};
  for (const auto& [file, terminal] : terminals) {
    out += fmt::format("set terminal {}\nset output '{}'\nset multiplot layout {},3\n",
                       fmt::format(fmt::runtime(terminal), 420 * rows), file, rows);
    for (std::size_t p = 0; p < panels.size(); ++p) {
      out += "unset key\nset border\nset grid\nset tics\nset logscale xy\nset format '%.0e'\nset autoscale\n";
      out += draw(findings, panels[p], methods);
      if (p % 2 == 0) continue;
      if (p > 1) {
        out += "set multiplot next\n";
        continue;
      }
      // The legend has a place of its own.
      out +=
          "unset logscale\nunset tics\nunset border\nunset grid\nunset xlabel\nunset ylabel\nunset title\n"
          "set key at graph 0, graph 1 left top Left reverse vertical maxrows 28 samplen 2 font ',9'\nplot [0:1] "
          "[0:1] ";
      for (std::size_t i = 0; i < methods.size(); ++i) {
        const bool strong = std::any_of(panels.begin(), panels.end(),
                                        [&](const ErrorPanel& panel) { return panel.is_cheapest(methods[i]); });
        const Style style = style_of(i);
        out += fmt::format("NaN with linespoints {} title '{}', ", strong ? style.strong : style.pale, methods[i]);
      }
      out += fmt::format("NaN with points {} title 'failed'\n", failed_style);
    }
    out += "unset multiplot\n";
  }
  return out;
}

std::string row(const std::vector<std::string>& cells, const char* tag = "td") {
  std::string out = "<tr>";
  for (const auto& c : cells) out += fmt::format("<{0}>{1}</{0}>", tag, in_html(c));
  return out + "</tr>\n";
}

std::vector<std::string> cells(const Measurement& m) {
  return {m.method,
          fmt::format("{:.4g}", m.step),
          std::to_string(m.work.steps),
          std::to_string(m.work.evaluations),
          std::isfinite(m.median()) ? duration(m.median()) : "",
          std::isfinite(m.spread()) ? fmt::format("{:.0f} %", 100 * m.spread()) : "",
          cell(m.trajectory),
          cell(m.invariants),
          cell(m.constraint),
          std::isfinite(m.drift) ? fmt::format("{:.1g} +- {:.1g}", m.drift, m.drift_error) : "",
          m.converged() ? "" : fmt::format("{} {}", m.status, m.message)};
}

const std::vector<std::string> headings{"method",     "step",       "steps",      "evaluations",  "time",  "spread",
                                        "trajectory", "invariants", "constraint", "energy drift", "failed"};

std::string html(const Findings& findings, const std::string& picture) {
  std::string out = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}: what accuracy costs</title>\n"
      "<style>body{{font:15px/1.5 sans-serif;max-width:1320px;margin:2em auto;padding:0 1em;color:#222}}"
      "table{{border-collapse:collapse;font-size:13px}}td,th{{padding:2px 9px;border-bottom:1px solid #ddd;"
      "text-align:right}}td:first-child,th:first-child{{text-align:left}}code{{background:#f3f3f3;padding:0 3px}}"
      "svg{{max-width:100%;height:auto}}.failed{{color:#a00}}</style></head><body>\n<h1>{0}: what accuracy "
      "costs</h1>\n",
      in_html(findings.name));
  for (const auto& line : recommendation(findings)) out += fmt::format("<p><b>{}</b></p>\n", in_html(line));
  out += fmt::format(
      "<p>Written by <code>{}</code>. To t = {:g}. Reference: {}, uncertain by {:.1g}. {}.</p>\n"
      "<p>Errors: <i>trajectory</i>, of configuration and momentum at the end, relative to their size along the "
      "motion; "
      "<i>invariants</i>, the largest deviation of energy and momenta from the first node's at any node, relative to "
      "their terms; <i>constraint</i>, the largest residual of constraints and of the groupoid's own equations. "
      "<i>Energy drift</i> is the slope of the energy times the time, with its standard error. Evaluations: gradients "
      "of the discrete Lagrangian (Newton's iterations), flows or vector fields of explicit steps. Times are medians "
      "of interleaved repetitions, the steps alone, without records, in processor time of their thread. An error "
      "beyond "
      "the motion's own size is a failure (a cross above), no point. Strongly drawn are the methods that are the "
      "cheapest at some error.</p>\n",
      in_html(findings.command), findings.end, in_html(findings.reference), findings.uncertainty,
      in_html(findings.machine));
  for (const auto& line : not_measured(findings)) out += fmt::format("<p>Not measured: {}</p>\n", in_html(line));
  out += picture;
  out += "<h2>The least time for an error of the trajectory</h2>\n<table>" +
         row({"error", "method", "step", "time", "evaluations"}, "th");
  for (const double level : levels(findings)) {
    const auto cost = least_cost(findings.runs, Axis::trajectory, level);
    out += cost ? row({fmt::format("{:.0e}", level), cost->method, fmt::format("{:.4g}", cost->step),
                       duration(cost->seconds), fmt::format("{:.0f}", cost->evaluations)})
                : row({fmt::format("{:.0e}", level), "not reached by any run", "", "", ""});
  }
  out += "</table>\n<h2>All runs</h2>\n<table>" + row(headings, "th");
  for (const Measurement& m : findings.runs) {
    std::string line = row(cells(m));
    if (!m.converged()) line.replace(0, 4, "<tr class=\"failed\">");
    out += line;
  }
  return out + "</table>\n</body></html>\n";
}

std::string line_of(const std::vector<std::string>& cells) {
  std::string out = "|";
  for (const auto& c : cells) out += " " + in_markdown(c) + " |";
  return out + "\n";
}

std::string markdown(const Findings& findings, bool pictures) {
  std::string out = fmt::format("# {}, to t = {:g}\n\nWritten by\n\n    {}\n\n", in_markdown(findings.name),
                                findings.end, visible(findings.command));
  out += fmt::format(
      "{}. Reference: {}, uncertain by {:.1g}. What the columns mean: docs/scenes.md, *What accuracy costs a "
      "scene*.\n\n",
      in_markdown(findings.machine), in_markdown(findings.reference), findings.uncertainty);
  if (pictures) out += "![error over time and evaluations](study.svg)\n\n";
  out += "| error of the trajectory | least time | method | step |\n|---|---|---|---|\n";
  for (const double level : levels(findings)) {
    const auto cost = least_cost(findings.runs, Axis::trajectory, level);
    out += cost ? line_of({fmt::format("{:.0e}", level), duration(cost->seconds), cost->method,
                           fmt::format("{:.4g}", cost->step)})
                : line_of({fmt::format("{:.0e}", level), "not reached", "", ""});
  }
  out += "\n";
  for (const auto& line : recommendation(findings)) out += fmt::format("- {}\n", in_markdown(line));
  for (const auto& line : not_measured(findings)) out += fmt::format("- not measured: {}\n", in_markdown(line));
  out += "\n" + line_of(headings) + "|" + [] {
    std::string rule;
    for (std::size_t i = 0; i < headings.size(); ++i) rule += "---|";
    return rule;
  }() + "\n";
  for (const Measurement& m : findings.runs) out += line_of(cells(m));
  return out;
}

}  // namespace

OutputFolder folder_for_study(const std::filesystem::path& folder, const std::string& scene, const std::string& methods,
                              const std::vector<double>& steps, const std::string& reference, int repetitions) {
  const std::string options =
      fmt::format("{}\n{:.17g}\n{}\n{}", methods, fmt::join(steps, ","), reference, repetitions);
  return {folder, OutputKind::study, OutputSource{{"scene", scene}, {"options", options}}, study_files};
}

std::vector<std::string> recommendation(const Findings& findings) {
  std::vector<std::string> out;
  for (const double level : {findings.target, 0.1 * findings.target}) {
    if (level <= 3 * findings.uncertainty) {
      out.push_back(fmt::format("an error of {:.1e} is not told apart from none by the reference (uncertain by {:.1e})",
                                level, findings.uncertainty));
      continue;
    }
    if (const auto cost = least_cost(findings.runs, Axis::trajectory, level))
      out.push_back(
          fmt::format("for an error of {:.1e} at t = {:g} use {} with steps of {:.4g}: it costs {} ([time] {})", level,
                      findings.end, cost->method, cost->step, duration(cost->seconds), settings(findings, *cost)));
    else
      out.push_back(
          fmt::format("no run came below an error of {:.1e} at t = {:g}: give smaller steps or more time "
                      "(longest, budget)",
                      level, findings.end));
  }
  return out;
}

std::vector<std::string> not_measured(const Findings& findings) {
  std::vector<std::string> out;
  if (findings.interrupted) return out;  // that was no budget
  for (const LeftOut& each : findings.left_out)
    out.push_back(fmt::format("{} with steps of {:.4g} and less: {}", each.method, each.step, each.why));
  const auto is_short = [&](const Measurement& m) {
    return m.converged() && m.seconds.size() < std::size_t(findings.repetitions);
  };
  if (const auto count = std::count_if(findings.runs.begin(), findings.runs.end(), is_short); count > 0)
    out.push_back(fmt::format("{} of {} runs were timed less than {} times (the repetitions are in study.json)", count,
                              findings.runs.size(), findings.repetitions));
  if (!out.empty()) out.push_back(fmt::format("all of this for want of time: the budget was {:g} s", findings.budget));
  return out;
}

std::string study_text(const Findings& findings) {
  std::string out = fmt::format("{} to t = {:g}: error against time\n  reference: {}, uncertain by {:.1g}\n",
                                findings.name, findings.end, findings.reference, findings.uncertainty);
  out += fmt::format("\n  {:<26} {:>10} {:>9} {:>11} {:>10} {:>10} {:>10} {:>10}\n", "method", "step", "steps",
                     "evaluations", "time", "trajectory", "invariants", "constraint");
  for (const Measurement& m : findings.runs) {
    const auto c = cells(m);
    out += fmt::format("  {:<26} {:>10} {:>9} {:>11} {:>10} {:>10} {:>10} {:>10}{}\n", c[0], c[1], c[2], c[3], c[4],
                       c[6], c[7], c[8], m.converged() ? "" : "  failed: " + c[10]);
  }
  out += "\n  error of the trajectory: the least time, and with which method\n";
  for (const double level : levels(findings))
    if (const auto cost = least_cost(findings.runs, Axis::trajectory, level))
      out += fmt::format("    {:.0e}  {:>10}  {} (step {:.4g})\n", level, duration(cost->seconds), cost->method,
                         cost->step);
  out += "\n";
  for (const auto& line : recommendation(findings)) out += fmt::format("  {}\n", line);
  for (const auto& line : not_measured(findings)) out += fmt::format("  not measured: {}\n", line);
  return out;
}

std::string study_json(const Findings& findings) {
  OrderedJson out;
  out["status"] = findings.interrupted ? "interrupted" : "done";
  out["scene"] = findings.scene;
  out["system"] = findings.name;
  out["command"] = findings.command;
  out["machine"] = findings.machine;
  out["time"] = findings.end;
  out["reference"] = {{"method", findings.reference}, {"uncertainty", findings.uncertainty}};
  for (const NamedVector& block : findings.reference_state) {
    OrderedJson b = {{"name", block.name}, {"size", block.size}, {"values", block.values}};
    out["reference"]["state"].push_back(b);
  }
  for (const Measurement& m : findings.runs)
    out["runs"].push_back({{"method", m.method},
                           {"order", m.order},
                           {"step", m.step},
                           {"steps", m.work.steps},
                           {"evaluations", m.work.evaluations},
                           {"seconds", m.median()},
                           {"spread", m.spread()},
                           {"repetitions", m.seconds.size()},
                           {"trajectory", m.trajectory},
                           {"invariants", m.invariants},
                           {"constraint", m.constraint},
                           {"energy_drift", m.drift},
                           {"energy_drift_error", m.drift_error},
                           {"status", m.status},
                           {"message", m.message}});
  for (const Axis axis : axes) {
    if (!has(findings, axis)) continue;
    for (const double level : levels(findings))
      if (const auto cost = least_cost(findings.runs, axis, level))
        out["least_time"][name_of(axis)].push_back({{"error", level},
                                                    {"method", cost->method},
                                                    {"step", cost->step},
                                                    {"seconds", cost->seconds},
                                                    {"evaluations", cost->evaluations}});
  }
  for (const auto& line : recommendation(findings)) out["recommendation"].push_back(line);
  out["budget"] = findings.budget;
  out["not_measured"] = OrderedJson::array();
  for (const LeftOut& each : findings.left_out)
    out["not_measured"].push_back({{"method", each.method}, {"step", each.step}, {"why", each.why}});
  return json_text(out);
}

std::vector<std::filesystem::path> write_study(const Findings& findings, const std::filesystem::path& folder,
                                               std::string& note) {
  const auto data = [&](const std::filesystem::path& staging) {
    write_text(csv(findings), staging / "study.csv");
    write_text(study_json(findings) + "\n", staging / "study.json");
    write_text(figure(findings), staging / "study.gp");
    return std::vector<std::string>{"study.csv", "study.json", "study.gp"};
  };
  const auto pages = [&](const std::filesystem::path& staging, bool drawn) {
    std::string picture;
    if (drawn) {
      std::ifstream in(folder / "study.svg");
      picture.assign(std::istreambuf_iterator<char>(in), {});
      if (const auto start = picture.find("<svg"); start != std::string::npos) picture.erase(0, start);
    }
    write_text(markdown(findings, drawn), staging / "study.md");
    write_text(html(findings, picture), staging / "study.html");
    return std::vector<std::string>{"study.md", "study.html"};
  };
  if (!error_panels(findings).empty())
    return write_and_draw(folder, study_files, data, {"study.gp", {"study.svg", "study.png"}}, note, pages);
  auto written = write_and_draw(folder, study_files, data, {}, note, pages);
  note = "no run came near enough to the truth to be drawn";
  return written;
}

}  // namespace lagroid
