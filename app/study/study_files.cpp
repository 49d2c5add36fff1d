#include "study_files.hpp"

#include "../clock.hpp"
#include "../output_folder.hpp"
#include "costs.hpp"
#include "methods.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>

namespace lagroid::app {

const std::vector<const char*> study_files{"study.csv", "study.json", "study.md",  "study.gp",
                                           "study.svg", "study.png",  "study.html"};

namespace {

using Json = nlohmann::ordered_json;

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }
std::string cell(double x, const char* format = "{:.2g}") {
  return std::isfinite(x) ? fmt::format(fmt::runtime(format), x) : "";
}

const Method& method_of(const Findings& findings, const std::string& name) {
  return *std::find_if(findings.methods.begin(), findings.methods.end(),
                       [&](const Method& m) { return m.name == name; });
}

bool has(const Findings& findings, Axis axis) {
  return std::any_of(findings.runs.begin(), findings.runs.end(),
                     [&](const Measurement& m) { return error_of(m, axis) > 0; });
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
    out += fmt::format("{},{},{:.9g},{},{},{},{},{},{},{},{},{},{},{},\"{}\"\n", m.method, m.order, m.step,
                       m.work.steps, m.work.evaluations, cell(m.median(), "{:.4g}"), cell(m.spread()), m.seconds.size(),
                       cell(m.trajectory, "{:.4g}"), cell(m.invariants, "{:.4g}"), cell(m.constraint, "{:.4g}"),
                       cell(m.drift, "{:.4g}"), cell(m.drift_error, "{:.4g}"), m.status, m.message);
  return out;
}

/// As a gnuplot string in single quotes.
std::string in_quotes(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out;
}

/// Methods of a kind (what stands before the stroke in their names) share a colour, and differ in their points.
std::vector<std::string> line_styles(const std::vector<std::string>& methods) {
  constexpr std::array points{7, 5, 9, 13, 4, 6, 8, 12, 1, 2, 3, 10, 11};
  std::vector<std::string> kinds;
  std::vector<std::size_t> counts;
  std::vector<std::string> out;
  for (const std::string& method : methods) {
    const std::string kind = method.substr(0, method.find('/'));
    const auto at = std::size_t(std::find(kinds.begin(), kinds.end(), kind) - kinds.begin());
    if (at == kinds.size()) {
      kinds.push_back(kind);
      counts.push_back(0);
    }
    out.push_back(fmt::format("linecolor {} pointtype {} pointsize 0.6", at + 1, points[counts[at]++ % points.size()]));
  }
  return out;
}

std::string figure(const Findings& findings) {
  std::string out = "# Draws study.csv; run by lagroid, or by hand: gnuplot study.gp\nset datafile separator ','\n";
  const auto methods = methods_of(findings.runs);
  const auto styles = line_styles(methods);
  const std::string failed = "pointtype 2 pointsize 0.8 linecolor 'black'";
  std::vector<Axis> drawn;
  for (const Axis axis : axes)
    if (has(findings, axis)) drawn.push_back(axis);
  const std::pair<const char*, std::string> terminals[] = {
      {"study.svg", "svg size 1400,{} background 'white' noenhanced font ',11'"},
      {"study.png", "pngcairo size 1400,{} noenhanced"}};
  for (const auto& [file, terminal] : terminals) {
    out += fmt::format("set terminal {}\nset output '{}'\nset multiplot layout {},3\n",
                       fmt::format(fmt::runtime(terminal), 420 * drawn.size()), file, drawn.size());
    for (const Axis axis : drawn) {
      out += "unset key\nset border\nset grid\nset tics\nset logscale xy\nset format '%.0e'\nset autoscale\n";
      double most = 0;
      for (const Measurement& m : findings.runs)
        if (const double error = error_of(m, axis); m.converged() && std::isfinite(error)) most = std::max(most, error);
      for (const auto& [column, label] : {std::pair("seconds", "time, s"), std::pair("evaluations", "evaluations")}) {
        out += fmt::format("set xlabel '{}'\nset ylabel 'error: {}'\nset title '{}'\n", label, name_of(axis),
                           axis == Axis::trajectory
                               ? fmt::format("{}, state at t = {:g}", in_quotes(findings.name), findings.end)
                               : fmt::format("{}, worst at any node", in_quotes(findings.name)));
        out += "plot ";
        for (std::size_t i = 0; i < methods.size(); ++i)
          out += fmt::format(
              "'study.csv' using (column('{}')):((strcol('method') eq '{}') && (strcol('status') eq 'converged') && "
              "(column('{}') > 0) ? column('{}') : NaN) with linespoints {}, ",
              column, methods[i], name_of(axis), name_of(axis), styles[i]);
        out += fmt::format(
            "'study.csv' using (column('{}')):(strcol('status') ne 'converged' ? {:.3g} : NaN) with points "
            "{}\n",
            column, 3 * most, failed);
      }
      if (axis != drawn.front()) {
        out += "set multiplot next\n";
        continue;
      }
      // The legend has a place of its own.
      out +=
          "unset logscale\nunset tics\nunset border\nunset grid\nunset xlabel\nunset ylabel\nunset title\n"
          "set key at graph 0, graph 1 left top Left reverse vertical maxcols 1 samplen 2 font ',9'\nplot [0:1] [0:1] ";
      for (std::size_t i = 0; i < methods.size(); ++i)
        out += fmt::format("NaN with linespoints {} title '{}', ", styles[i], methods[i]);
      out += fmt::format("NaN with points {} title 'failed'\n", failed);
    }
    out += "unset multiplot\n";
  }
  return out;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string row(const std::vector<std::string>& cells, const char* tag = "td") {
  std::string out = "<tr>";
  for (const auto& c : cells) out += fmt::format("<{0}>{1}</{0}>", tag, escaped(c));
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
      escaped(findings.name));
  for (const auto& line : recommendation(findings)) out += fmt::format("<p><b>{}</b></p>\n", escaped(line));
  out += fmt::format(
      "<p>Written by <code>{}</code>. To t = {:g}. Reference: {}, uncertain by {:.1g}. {}.</p>\n"
      "<p>Errors: <i>trajectory</i>, of configuration and momentum at the end, relative to their size along the "
      "motion; "
      "<i>invariants</i>, the largest deviation of energy and momenta from the first node's at any node, relative to "
      "their terms; <i>constraint</i>, the largest residual of constraints and of the groupoid's own equations. "
      "<i>Energy drift</i> is the slope of the energy times the time, with its standard error. Evaluations: gradients "
      "of the discrete Lagrangian (Newton's iterations), flows or vector fields of explicit steps. Times are medians "
      "of interleaved repetitions, the march alone, without records, in processor time of its thread.</p>\n",
      escaped(findings.command), findings.end, escaped(findings.reference), findings.uncertainty,
      escaped(findings.machine));
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
  for (const auto& c : cells) out += " " + c + " |";
  return out + "\n";
}

std::string markdown(const Findings& findings, bool pictures) {
  std::string out =
      fmt::format("# {}, to t = {:g}\n\nWritten by\n\n    {}\n\n", findings.name, findings.end, findings.command);
  out += fmt::format(
      "{}. Reference: {}, uncertain by {:.1g}. What the columns mean: docs/scenes.md, *What accuracy costs a "
      "scene*.\n\n",
      findings.machine, findings.reference, findings.uncertainty);
  if (pictures) out += "![error over time and evaluations](study.svg)\n\n";
  out += "| error of the trajectory | least time | method | step |\n|---|---|---|---|\n";
  for (const double level : levels(findings)) {
    const auto cost = least_cost(findings.runs, Axis::trajectory, level);
    out += cost ? line_of({fmt::format("{:.0e}", level), duration(cost->seconds), cost->method,
                           fmt::format("{:.4g}", cost->step)})
                : line_of({fmt::format("{:.0e}", level), "not reached", "", ""});
  }
  out += "\n";
  for (const auto& line : recommendation(findings)) out += fmt::format("- {}\n", line);
  out += "\n" + line_of(headings) + "|" + [] {
    std::string rule;
    for (std::size_t i = 0; i < headings.size(); ++i) rule += "---|";
    return rule;
  }() + "\n";
  for (const Measurement& m : findings.runs) out += line_of(cells(m));
  return out;
}

}  // namespace

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
          fmt::format("no run came below an error of {:.1e} at t = {:g}: give smaller --steps or more time "
                      "(--longest)",
                      level, findings.end));
  }
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
  return out;
}

std::string study_json(const Findings& findings) {
  Json out;
  out["status"] = findings.interrupted ? "interrupted" : "done";
  out["scene"] = findings.scene;
  out["system"] = findings.name;
  out["command"] = findings.command;
  out["machine"] = findings.machine;
  out["time"] = findings.end;
  out["reference"] = {{"method", findings.reference}, {"uncertainty", number(findings.uncertainty)}};
  for (const Block& block : findings.reference_state) {
    Json b = {{"name", block.name}, {"size", block.size}, {"values", block.values}};
    out["reference"]["state"].push_back(b);
  }
  for (const Measurement& m : findings.runs)
    out["runs"].push_back({{"method", m.method},
                           {"order", m.order},
                           {"step", m.step},
                           {"steps", m.work.steps},
                           {"evaluations", m.work.evaluations},
                           {"seconds", number(m.median())},
                           {"spread", number(m.spread())},
                           {"repetitions", m.seconds.size()},
                           {"trajectory", number(m.trajectory)},
                           {"invariants", number(m.invariants)},
                           {"constraint", number(m.constraint)},
                           {"energy_drift", number(m.drift)},
                           {"energy_drift_error", number(m.drift_error)},
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
  return out.dump(2);
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
  return write_and_draw(folder, study_files, data, {"study.gp", {"study.svg", "study.png"}}, note, pages);
}

}  // namespace lagroid::app
