#include "page.hpp"

#include "libraries/libraries.hpp"

#include "../report/pages.hpp"

#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/run/reports/clock.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

namespace peers {

namespace {

using lagroid::duration;

constexpr double long_time = 1e4;

bool is_ours(const Method& method) { return method.library == ours; }
std::string full_name(const Method& method) {
  return is_ours(method) ? method.name : method.library + " " + method.name;
}

std::string setting_of(const Method& method, double setting) {
  return fmt::format("{} {:.2g}", method.tolerance ? "tol" : "h", setting);
}

/// Ours against others at one error.
struct Comparison {
  double error;
  Cheapest we;
  Cheapest they;
  double wanted;

  bool we_arrive() const { return std::isfinite(we.cost.seconds); }
  bool they_arrive() const { return std::isfinite(they.cost.seconds); }
  double ratio() const { return they.cost.seconds / we.cost.seconds; }
  bool reached() const { return we_arrive() ? ratio() >= wanted : !they_arrive(); }
  std::string verdict() const {
    if (!we_arrive()) return they_arrive() ? "**loss**: we do not get there" : "nobody gets there";
    if (!they_arrive()) return "win: no other gets there";
    if (ratio() >= wanted) return "win";
    return ratio() >= 1 ? fmt::format("win, **less than {:g}**", wanted) : "**loss**";
  }
};

/// Those whom we mean to beat by so much.
struct Rivals {
  std::string title;
  std::function<bool(const Method&)> are;
  std::function<double(const Problem&, double end)> wanted;
};

double faster(const Problem&, double end) { return end >= long_time ? 3 : 1; }

const Rivals named{"the methods named", [](const Method& method) { return !is_ours(method) && !method.beyond; },
                   faster};
const Rivals all_others{"all methods of theirs", [](const Method& method) { return !is_ours(method); }, faster};
const Rivals mujoco{"MuJoCo's RK4",
                    [](const Method& method) { return method.library == "MuJoCo" && method.name == "RK4"; },
                    [](const Problem& problem, double) { return problem.name == "chain" ? 500.0 : 50.0; }};

const std::vector<const Rivals*> all_rivals{&named, &all_others, &mujoco};

bool are_there(const Rivals& rivals, const Problem& problem) {
  return std::any_of(problem.methods.begin(), problem.methods.end(), rivals.are);
}

Comparison against(const Rivals& rivals, const Findings& found, const Study& study, double error) {
  return {error, cheapest(found.problem, study, error, is_ours), cheapest(found.problem, study, error, rivals.are),
          rivals.wanted(found.problem, study.end)};
}

std::string row(const Findings& found, const Comparison& c) {
  const auto subject = [&](const Cheapest& one) {
    if (!std::isfinite(one.cost.seconds)) return std::string("- | -");
    const Method& method = found.problem.methods[one.method];
    return fmt::format("{} | {}, {}", duration(one.cost.seconds), full_name(method),
                       setting_of(method, one.cost.setting));
  };
  const std::string ratio = c.we_arrive() && c.they_arrive() ? fmt::format("{:.3g}", c.ratio()) : "";
  return fmt::format("{:.0e} | {} | {} | {} | {}", c.error, subject(c.we), subject(c.they), ratio, c.verdict());
}

/// What a method's best and its failures were.
std::string notes_of(const Study& study, std::size_t method) {
  double best = INFINITY;
  double drift = 0;
  std::map<std::string, int> failures;
  for (const Run& run : study.runs) {
    if (run.method != method) continue;
    if (!run.failure.empty()) ++failures[run.failure];
    if (run.error < best) {
      best = run.error;
      drift = run.drift;
    }
  }
  std::string out = std::isfinite(best) ? fmt::format("{:.1e} | {:.1e} | ", best, drift) : "- | - | ";
  std::string separator;
  for (const auto& [why, count] : failures) {
    out += fmt::format("{}{} x {}", separator, count, why);
    separator = ", ";
  }
  return out;
}

std::string tables(const Findings& found, const Study& study) {
  const auto levels = error_levels(study);
  std::string out =
      fmt::format("\n**T = {:g}.** The reference is uncertain by {:.1e}; the smallest error of any method is {:.1e}.\n",
                  study.end, study.reference.uncertainty, study.floor);
  for (const Rivals* rivals : all_rivals) {
    if (!are_there(*rivals, found.problem)) continue;
    out += fmt::format(
        "\n| error | ours | by | best of {} | by | their time over ours | |\n|---|---|---|---|---|---|---|\n",
        rivals->title);
    for (const double level : levels) out += "| " + row(found, against(*rivals, found, study, level)) + " |\n";
  }
  out += "\n| time for an error of |";
  std::string rule = "\n|---|";
  for (const double level : levels) {
    out += fmt::format(" {:.0e} |", level);
    rule += "---|";
  }
  out += " smallest error | drift there | failed runs |" + rule + "---|---|---|\n";
  for (std::size_t m = 0; m < found.problem.methods.size(); ++m) {
    out += fmt::format("| {} |", full_name(found.problem.methods[m]));
    for (const double level : levels) out += " " + duration(cost(study, m, level).seconds) + " |";
    out += " " + notes_of(study, m) + " |\n";
  }
  return out;
}

/// How often we are as far ahead of them as we want to be, and where not.
std::string comparisons(const Rivals& rivals, const std::vector<Findings>& all) {
  int reached = 0;
  int count = 0;
  std::string short_of;
  for (const Findings& found : all) {
    if (!are_there(rivals, found.problem)) continue;
    for (const Study& study : found.studies)
      for (const double level : error_levels(study)) {
        const Comparison c = against(rivals, found, study, level);
        if (!c.they_arrive() && !c.we_arrive()) continue;
        ++count;
        if (c.reached()) {
          ++reached;
        } else {
          short_of +=
              fmt::format("| {} | {:g} | {} | {:g} |\n", found.problem.title, study.end, row(found, c), c.wanted);
        }
      }
  }
  std::string out =
      fmt::format("**Against {}**: of {} comparisons {} reach what is wanted.", rivals.title, count, reached);
  if (!short_of.empty())
    out +=
        " These do not:\n\n| | T | error | ours | by | best of theirs | by | their time over ours | | wanted |\n"
        "|---|---|---|---|---|---|---|---|---|---|\n" +
        short_of;
  return out + "\n";
}

std::string runs_csv(const std::vector<Findings>& all) {
  std::string out = "problem,end,library,method,kind,setting,steps,error,drift,seconds,spread,failure\n";
  for (const Findings& found : all)
    for (const Study& study : found.studies)
      for (const Run& run : study.runs) {
        const Method& method = found.problem.methods[run.method];
        out += fmt::format("{},{:g},{},\"{}\",{},{:.4g},{},{:.4g},{:.3g},{:.4g},{:.2f},\"{}\"\n", found.problem.name,
                           study.end, method.library, method.name, method.tolerance ? "tolerance" : "step", run.setting,
                           run.steps, run.error, run.drift, run.seconds, run.spread, run.failure);
      }
  return out;
}

/// Of ours those that are the cheapest at some error, and all others.
std::vector<const Method*> shown(const Findings& found, const Study& study) {
  std::vector<const Method*> out;
  for (const Method& method : found.problem.methods)
    if (!is_ours(method)) out.push_back(&method);
  std::set<std::size_t> best;
  for (const double level : error_levels(study))
    if (const Cheapest one = cheapest(found.problem, study, level, is_ours); std::isfinite(one.cost.seconds))
      best.insert(one.method);
  for (const std::size_t m : best) out.push_back(&found.problem.methods[m]);
  return out;
}

/// Within single quotes, as gnuplot reads them.
std::string quoted(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '\'' ? "''" : std::string(1, c);
  return out;
}

/// Error over time; ours with lines, others broken.
std::string figures(const std::vector<Findings>& all) {
  std::string out =
      "# Draws the figures of peers.md: gnuplot figures.gp\nset datafile separator ','\nset grid\n"
      "set logscale xy\nset format '%.0e'\nset key below font ',8'\nset xlabel 'processor time, s'\n"
      "set ylabel 'error at the end'\n";
  for (const Findings& found : all) {
    out += fmt::format(
        "set terminal svg size 1200,760 background 'white' noenhanced font ',11'\nset output '{}.svg'\n"
        "set multiplot layout 1,{}\n",
        found.problem.name, found.studies.size());
    for (const Study& study : found.studies) {
      out += fmt::format("set title '{}, T = {:g}'\nset yrange [{:.1e}:10]\nplot ", quoted(found.problem.title),
                         study.end, 0.3 * study.floor);
      std::string separator;
      for (const Method* method : shown(found, study)) {
        out += fmt::format(
            "{}'runs.csv' using (column('seconds')):((strcol('problem') eq '{}') && (column('end') == {:g}) && "
            "(strcol('library') eq '{}') && (strcol('method') eq '{}') && (strcol('failure') eq '') ? column('error') "
            ": NaN) with linespoints pointtype 7 pointsize 0.4 {} title '{}'",
            separator, found.problem.name, study.end, method->library, method->name,
            is_ours(*method) ? "dashtype 1" : "dashtype 2", quoted(full_name(*method)));
        separator = ", ";
      }
      out += "\n";
    }
    out += "unset multiplot\n";
  }
  return out;
}

std::string versions() {
  std::string out;
#ifdef LAGROID_PEER_ODEINT
  out += ", " + odeint_version();
#endif
#ifdef LAGROID_PEER_SUNDIALS
  out += ", " + sundials_version();
#endif
#ifdef LAGROID_PEER_MUJOCO
  out += ", " + mujoco_version();
#endif
#ifdef LAGROID_PEER_BULLET
  out += ", " + bullet_version();
#endif
#ifdef LAGROID_PEER_ODE
  out += ", " + ode_version();
#endif
  return out;
}

}  // namespace

std::string section(const Findings& found) {
  std::string out = fmt::format("## {}\n\n{}\n", found.problem.title, found.problem.remarks);
  for (const Study& study : found.studies) out += tables(found, study);
  return out;
}

std::string summary(const std::vector<Findings>& all) {
  std::string out;
  for (const Rivals* rivals : all_rivals) out += comparisons(*rivals, all);
  return out;
}

namespace {

/// The rows of the page of performance that say so.
std::string missed_goals(const std::string& page) {
  std::string out = "| | ratio | wanted | |\n|---|---|---|---|\n";
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("|") && line.find("**missed**") != std::string::npos) out += line + "\n";
  return out;
}

}  // namespace

void write_page(const std::vector<Findings>& all) {
  const std::filesystem::path docs = LAGROID_SOURCE "/docs";
  std::vector<std::string> pictures;
  for (const Findings& found : all) pictures.push_back(found.problem.name + ".svg");
  std::vector<const char*> files{"runs.csv", "figures.gp"};
  for (const std::string& name : pictures) files.push_back(name.c_str());
  const auto data = [&](const std::filesystem::path& staging) {
    lagroid::write_text(runs_csv(all), staging / "runs.csv");
    lagroid::write_text(figures(all), staging / "figures.gp");
    return std::vector<std::string>{"runs.csv", "figures.gp"};
  };
  std::string reason;
  lagroid::write_and_draw(docs / "peers", files, data, {"figures.gp", pictures}, reason);
  if (!reason.empty())
    fmt::print(stderr, "lagroid_peers: no pictures: {}; in docs/peers, gnuplot figures.gp draws them\n", reason);
  std::string sections;
  for (const Findings& found : all) {
    sections += section(found);
    sections += fmt::format("\n![error over time](peers/{}.svg)\n\n", found.problem.name);
  }
  std::string page = bench::file_contents(LAGROID_SOURCE "/bench/peers/peers.md.in");
  bench::put(page, "@MACHINE@", bench::machine() + versions());
  bench::put(page, "@SUMMARY@", summary(all));
  bench::put(page, "@PROBLEMS@", sections);
  bench::write_whole(docs / "peers.md", page);

  std::string audit = bench::file_contents(LAGROID_SOURCE "/bench/peers/audit.md.in");
  bench::put(audit, "@MACHINE@", bench::machine() + versions());
  bench::put(audit, "@SUMMARY@", summary(all));
  bench::put(audit, "@MISSED@", missed_goals(bench::file_contents(docs / "performance.md")));
  bench::write_whole(docs / "audit.md", audit);
}

}  // namespace peers
