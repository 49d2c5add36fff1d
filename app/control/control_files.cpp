#include "control_files.hpp"

#include "results/acting.hpp"
#include "results/recorded_control.hpp"
#include "results/row_words.hpp"

#include <lagroid/run/files/output.hpp>
#include <lagroid/run/reports/clock.hpp>
#include <lagroid/run/reports/gnuplot.hpp>
#include <lagroid/run/reports/markup.hpp>
#include <lagroid/run/reports/text.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace lagroid::app {

namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 7> files{"control.h5", "trajectory.csv", "summary.json", "summary.txt",
                                           "plot.gp",    "plot.svg",       "plot.png"};

/// What stands behind a cost.
std::string_view in_words(Curvature curvature) {
  switch (curvature) {
    case Curvature::open:
      break;
    case Curvature::strict_minimum:
      return ", a strict local minimum";
    case Curvature::saddle:
      return ", a saddle: near it are motions that cost less; try more solver.starts";
  }
  return "";
}

/// A row for each node; controls, costates and phase are those of the arrow that begins there, and none at the last.
std::string trajectory_csv(const ControlResult& found) {
  std::string out = "time";
  for (const auto& name : found.states) out += "," + name;
  for (const auto& name : found.controls) out += "," + name;
  const std::vector<CostateColumn> costates = costate_columns(found);
  for (const CostateColumn& each : costates) out += "," + each.name;
  if (!found.phases.empty()) out += ",phase";
  out += "\n";
  const std::vector<std::size_t> phase_of = phase_of_stages(found);
  for (std::size_t k = 0; k < found.times.size(); ++k) {
    fmt::format_to(std::back_inserter(out), "{:.17g}", found.times[k]);
    for (const double x : found.state_rows[k]) fmt::format_to(std::back_inserter(out), ",{:.17g}", x);
    const bool has_arrow = k < found.control_rows.size();
    for (std::size_t i = 0; i < found.controls.size(); ++i)
      out += has_arrow ? fmt::format(",{:.17g}", found.control_rows[k][i]) : ",";
    for (std::size_t i = 0; i < costates.size(); ++i)
      out += has_arrow ? fmt::format(",{:.17g}", found.costate_rows[k][i]) : ",";
    if (!found.phases.empty()) out += has_arrow ? fmt::format(",{}", phase_of[k] + 1) : ",";
    out += "\n";
  }
  return out;
}

/// Where one phase ends and the next begins, with their names.
std::string phase_borders(const ControlResult& found) {
  std::string out;
  double begin = 0;
  for (const PhaseResult& each : found.phases) {
    if (begin > 0)
      out += fmt::format("set arrow from {0:.17g}, graph 0 to {0:.17g}, graph 1 nohead dashtype 3\n", begin);
    out += fmt::format("set label {} at {:.17g}, graph 0.95 center\n", gnuplot_string(each.name),
                       begin + each.duration / 2);
    begin += each.duration;
  }
  return out;
}

/// The bounds of controls, phase by phase.
std::string phase_bounds(const ControlResult& found) {
  std::string out;
  double begin = 0;
  for (const PhaseResult& each : found.phases) {
    for (const auto* bounds : {&each.lower, &each.upper})
      for (const double bound : *bounds)
        if (std::isfinite(bound))
          out += fmt::format(
              "set arrow from {0:.17g}, {2:.17g} to {1:.17g}, {2:.17g} nohead dashtype 2 linecolor 'gray'\n", begin,
              begin + each.duration, bound);
    begin += each.duration;
  }
  return out;
}

/// Shades stages.
std::string bands(const ControlResult& found, const std::vector<StageRange>& stages) {
  std::string out;
  for (const StageRange& each : stages)
    out += fmt::format(
        "set object rectangle from {:.17g}, graph 0 to {:.17g}, graph 1 behind fillcolor rgb '#f6ead0' "
        "fillstyle solid noborder\n",
        found.times[each.first], found.times[each.end]);
  return out;
}

/// States above, controls below: their bounds are lines, and bands are where inequalities act.
std::string gnuplot_script(const ControlResult& found) {
  std::string out = fmt::format(
      "# Draws trajectory.csv; run by lagroid, or by hand: gnuplot plot.gp\n"
      "set datafile separator ','\nset grid\nset key outside right\nset xlabel 'time'\n"
      "set lmargin 10\nset rmargin 18\nset offsets 0, 0, graph 0.06, graph 0.06\n{}",
      found.control_rows.empty()
          ? ""
          : fmt::format("set xrange [{:.17g}:{:.17g}]\n", found.times.front(), found.times.back()));
  std::string states;
  for (const auto& name : found.states)
    states += fmt::format("{}'trajectory.csv' using 'time':'{}' with lines linewidth 1.5 title '{}'",
                          states.empty() ? "" : ", ", name, name);
  std::string controls;
  std::string last;  // the value of a stage holds to its end, which is no row of its own
  bool are_bounded = false;
  for (std::size_t i = 0; i < found.controls.size(); ++i) {
    controls += fmt::format("{}'trajectory.csv' using 'time':'{}' with steps linetype {} linewidth 1.5 title '{}'",
                            controls.empty() ? "" : ", ", found.controls[i], i + 1, found.controls[i]);
    if (!found.control_rows.empty())
      last += fmt::format("set arrow from {:.17g}, {:.17g} to {:.17g}, {:.17g} nohead linetype {} linewidth 1.5\n",
                          found.times[found.times.size() - 2], found.control_rows.back()[i], found.times.back(),
                          found.control_rows.back()[i], i + 1);
    for (const double bound : {found.lower[i], found.upper[i]})
      if (std::isfinite(bound)) {
        are_bounded = true;
        if (found.phases.empty())
          controls += fmt::format(", {:.17g} with lines dashtype 2 linecolor 'gray' notitle", bound);
      }
  }
  const std::string state_bands = bands(found, where_inequalities_act(found));
  for (const auto& [file, terminal] : {std::pair("plot.svg", "svg size 900,700 background 'white' noenhanced"),
                                       std::pair("plot.png", "pngcairo size 900,700 noenhanced")})
    out += fmt::format(
        "\nset terminal {}\nset output '{}'\n{}set multiplot layout 2,1\n{}set title 'state{}'\nplot {}\n"
        "unset object\n{}set title 'controls{}'\n{}{}plot {}\nunset multiplot\nset output\nunset object\n"
        "unset arrow\nunset label\n",
        terminal, file, phase_borders(found), state_bands, state_bands.empty() ? "" : "; bands: an inequality acts",
        states, bands(found, where_bounds_are_reached(found)),
        are_bounded ? ", and their bounds; bands: one is reached" : "", phase_bounds(found), last, controls);
  return out;
}

std::string loop_text(const ControlResult& found) {
  const LoopSummary& loop = *found.loop;
  const ControlReport& r = found.report;
  std::string out =
      fmt::format("{} on {}, in a closed loop that looks {} stages ahead: {}{}\n", found.problem, found.groupoid,
                  loop.stages, to_string(r.status), found.interrupted ? ", interrupted" : "");
  out +=
      fmt::format("  samples          {} in {:.12g}; {} not converged in their iterations, {} planned from nothing\n",
                  loop.samples, found.times.back(), loop.not_converged, loop.restarts);
  out += fmt::format("  cost             {:.12g}\n", r.cost);
  if (loop.samples == 0) return out;
  out += fmt::format("  iterations       median {}, of 99.9 % at most {}, most {}\n", loop.iterations_of(50),
                     loop.iterations_of(99.9), loop.iterations.rbegin()->first);
  const auto at = [&](double percent) { return duration(loop.latency.percentile(percent)); };
  out += fmt::format("  a solve took     median {}, 99 % {}, 99.9 % {}, longest {}\n", at(50), at(99), at(99.9),
                     duration(loop.latency.longest()));
  return out;
}

nlohmann::ordered_json loop_json(const LoopSummary& loop) {
  nlohmann::ordered_json out;
  out["stages"] = loop.stages;
  out["samples"] = loop.samples;
  out["not_converged"] = loop.not_converged;
  out["restarts"] = loop.restarts;
  out["iterations"] = nlohmann::ordered_json::object();
  for (const auto& [count, times] : loop.iterations) out["iterations"][std::to_string(count)] = times;
  for (const auto& [name, percent] : {std::pair("median", 50.0), std::pair("99", 99.0), std::pair("99.9", 99.9)})
    out["seconds"][name] = loop.latency.percentile(percent);
  out["seconds"]["longest"] = loop.latency.longest();
  return out;
}

nlohmann::ordered_json crossover_json(const CrossoverReport& r) {
  nlohmann::ordered_json out;
  out["status"] = to_string(r.status);
  if (!r.crossed()) return out;
  out["active"] = r.active;
  out["iterations"] = r.iterations;
  out["stationarity_before"] = r.before.stationarity;
  out["complementarity_before"] = r.before.complementarity;
  return out;
}

/// How many inequalities are active, or why that is not known.
std::string crossover_text(const CrossoverReport& r) {
  switch (r.status) {
    case CrossoverStatus::not_tried:
      return "";
    case CrossoverStatus::crossed:
      return fmt::format(
          "  active sets      {} inequalities; at the interior point {:.1e} stationarity, {:.1e} complementarity\n",
          r.active, r.before.stationarity, r.before.complementarity);
    case CrossoverStatus::degenerate:
      return "  active sets      not to be told, for a multiplier vanishes with its inequality: an interior point\n";
    case CrossoverStatus::not_improved:
      return "  active sets      no smaller residual: an interior point\n";
    case CrossoverStatus::interrupted:
      return "  active sets      interrupted: an interior point\n";
  }
  return "";
}

/// Which inequalities act, and at which stages: of many stretches the first few.
std::string acting_text(const ControlResult& found) {
  constexpr std::size_t most = 5;
  std::string out;
  for (const ActingInequality& each : acting_inequalities(found)) {
    std::vector<std::string> stages;
    for (std::size_t i = 0; i < std::min(most, each.stages.size()); ++i) {
      const auto& [first, last] = each.stages[i];
      stages.push_back(first == last ? fmt::format("{}", first) : fmt::format("{} to {}", first, last));
    }
    out += fmt::format("  active           {}: stages {}{}\n", each.name, fmt::join(stages, ", "),
                       each.stages.size() > most ? ", ..." : "");
  }
  return out;
}

}  // namespace

std::string control_text(const ControlResult& found) {
  if (found.loop) return loop_text(found);
  const ControlReport& r = found.report;
  std::string out = fmt::format("{} on {}, {} stages: {}{}\n", found.problem, found.groupoid, found.control_rows.size(),
                                to_string(r.status), found.by_ipopt ? ", by IPOPT" : "");
  out += fmt::format("  cost             {:.12g}{}\n", r.cost, in_words(r.curvature));
  if (found.end_cost) out += fmt::format("    of the end     {:.12g}\n", *found.end_cost);
  out += fmt::format("  duration         {:.12g}\n", found.times.back());
  for (const PhaseResult& each : found.phases)
    out += fmt::format("    {:<15}{:.12g} in {} stages\n", each.name, each.duration, each.stages);
  out += fmt::format("  KKT residual     {:.1e} stationarity, {:.1e} constraints, {:.1e} complementarity\n",
                     r.stationarity, r.violation, r.complementarity);
  out += crossover_text(found.crossover);
  out += acting_text(found);
  if (found.costs.size() > 1) {
    std::vector<std::string> others;
    for (std::size_t i = 1; i < std::min<std::size_t>(found.costs.size(), 6); ++i)
      others.push_back(fmt::format("{:.8g}", found.costs[i]));
    out += fmt::format("  other solutions  {}{}\n", fmt::join(others, ", "), found.costs.size() > 6 ? ", ..." : "");
  }
  std::vector<std::string> outcomes;
  for (const auto& [status, count] : found.outcomes) outcomes.push_back(fmt::format("{} {}", count, to_string(status)));
  out += fmt::format("  starts           {}; {} iterations in all, {} of the best; {}\n", fmt::join(outcomes, ", "),
                     found.iterations, r.iterations, duration(found.seconds));
  if (found.interrupted) out += "  interrupted      what is here is the best till then\n";
  for (const auto& each : r.worst) out += fmt::format("  violated         {}\n", in_words(found, each));
  for (const auto& each : repeated_in_words(found)) out += fmt::format("  repeated         {}\n", each);
  return out;
}

nlohmann::ordered_json control_json(const ControlResult& found) {
  const ControlReport& r = found.report;
  nlohmann::ordered_json out;
  out["status"] = to_string(r.status);
  out["interrupted"] = found.interrupted;
  out["method"] = found.by_ipopt ? "ipopt" : "interior_point";
  if (!r.message.empty()) out["message"] = r.message;
  out["problem"] = found.problem;
  out["groupoid"] = found.groupoid;
  out["stages"] = found.control_rows.size();
  out["cost"] = r.cost;
  if (found.end_cost) out["end_cost"] = *found.end_cost;
  out["duration"] = found.times.back();
  if (!found.phases.empty()) {
    out["phases"] = nlohmann::ordered_json::array();
    for (const PhaseResult& each : found.phases)
      out["phases"].push_back({{"name", each.name}, {"stages", each.stages}, {"duration", each.duration}});
  }
  if (!found.loop) {  // of which these are not one plan's
    out["strict_minimum"] = r.is_strict_minimum();
    out["saddle"] = r.is_saddle();
    out["stationarity"] = r.stationarity;
    out["violation"] = r.violation;
    out["complementarity"] = r.complementarity;
    out["iterations"] = r.iterations;
    out["crossover"] = crossover_json(found.crossover);
    out["costs"] = found.costs;
  }
  out["starts"] = nlohmann::ordered_json::object();
  for (const auto& [status, count] : found.outcomes) out["starts"][std::string(to_string(status))] = count;
  out["violated"] = nlohmann::ordered_json::array();
  for (const auto& each : r.worst) out["violated"].push_back(in_words(found, each));
  out["repeated"] = repeated_in_words(found);
  out["active"] = nlohmann::ordered_json::array();
  for (const auto& each : acting_inequalities(found))
    out["active"].push_back({{"name", each.name}, {"stages", each.stages}});
  out["costates"] = nlohmann::ordered_json::array();
  for (const auto& each : costate_columns(found))
    out["costates"].push_back({{"column", each.name}, {"unit", each.unit}, {"of", each.of}});
  out["conditions"] = nlohmann::ordered_json::array();
  for (const auto& each : node_conditions(found))
    out["conditions"].push_back(
        {{"column", fmt::format("condition_{}", each.column + 1)}, {"stages", each.stages}, {"name", each.name}});
  out["seconds"] = found.seconds;
  if (found.loop) out["loop"] = loop_json(*found.loop);
  return out;
}

OutputFolder folder_for_control(const fs::path& folder, const Section& scene) {
  return {folder, OutputKind::optimum, OutputSource{{"scene", scene.whole()}}, files};
}

std::vector<fs::path> write_control(const ControlResult& found, const fs::path& folder, std::string& note) {
  const auto make = [&](const fs::path& staging) {
    write_trajectory(recorded(found), staging / "control.h5");
    write_text(trajectory_csv(found), staging / "trajectory.csv");
    auto summary = control_json(found);
    summary["picture"] = picture_of(found);
    write_text(json_text(summary) + "\n", staging / "summary.json");
    write_text(visible(control_text(found), "\n"), staging / "summary.txt");
    write_text(gnuplot_script(found), staging / "plot.gp");
    return std::vector<std::string>{"control.h5", "trajectory.csv", "summary.json", "summary.txt", "plot.gp"};
  };
  return write_and_draw(folder, files, make, {"plot.gp", {"plot.svg", "plot.png"}}, note);
}

}  // namespace lagroid::app
