#include "page.hpp"

#include "libraries.hpp"

#include "../../app/output_folder.hpp"
#include "../pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace peers {

namespace {

constexpr double long_time = 1e4;

bool is_ours(const Method& method) { return method.library == ours; }
std::string full_name(const Method& method) {
  return is_ours(method) ? method.name : method.library + " " + method.name;
}

std::string time_of(double seconds) {
  if (!std::isfinite(seconds)) return "-";
  if (seconds < 1e-3) return fmt::format("{:.3g} us", 1e6 * seconds);
  if (seconds < 1) return fmt::format("{:.3g} ms", 1e3 * seconds);
  return fmt::format("{:.3g} s", seconds);
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

/// Another's method that we mean to beat by more than the best.
struct Mark {
  const char* problem;
  const char* library;
  const char* method;
  double wanted;
};
constexpr Mark marks[] = {{"rigid-body", "MuJoCo", "RK4", 50}, {"chain", "MuJoCo", "RK4", 500}};

Comparison against_best(const Findings& found, const Study& study, double error) {
  return {error, cheapest(found.problem, study, error, is_ours),
          cheapest(found.problem, study, error, [](const Method& m) { return !is_ours(m); }),
          study.end >= long_time ? 3.0 : 1.0};
}
Comparison against(const Mark& mark, const Findings& found, const Study& study, double error) {
  return {error, cheapest(found.problem, study, error, is_ours),
          cheapest(found.problem, study, error,
                   [&](const Method& m) { return m.library == mark.library && m.name == mark.method; }),
          mark.wanted};
}

std::string row(const Findings& found, const Comparison& c) {
  const auto subject = [&](const Cheapest& one) {
    if (!std::isfinite(one.cost.seconds)) return std::string("- | -");
    const Method& method = found.problem.methods[one.method];
    return fmt::format("{} | {}, {}", time_of(one.cost.seconds), full_name(method),
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
  std::string out = fmt::format(
      "\n**T = {:g}.** The reference is uncertain by {:.1e}; the smallest error of any method is {:.1e}.\n\n"
      "| error | ours | by | best other | by | their time over ours | |\n|---|---|---|---|---|---|---|\n",
      study.end, study.reference.uncertainty, study.floor);
  for (const double level : levels) out += "| " + row(found, against_best(found, study, level)) + " |\n";
  out += "\n| time for an error of |";
  std::string rule = "\n|---|";
  for (const double level : levels) {
    out += fmt::format(" {:.0e} |", level);
    rule += "---|";
  }
  out += " smallest error | drift there | failed runs |" + rule + "---|---|---|\n";
  for (std::size_t m = 0; m < found.problem.methods.size(); ++m) {
    out += fmt::format("| {} |", full_name(found.problem.methods[m]));
    for (const double level : levels) out += " " + time_of(cost(study, m, level).seconds) + " |";
    out += " " + notes_of(study, m) + " |\n";
  }
  return out;
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
      out += fmt::format("set title '{}, T = {:g}'\nset yrange [{:.1e}:10]\nplot ", found.problem.title, study.end,
                         0.3 * study.floor);
      std::string separator;
      for (const Method& method : found.problem.methods) {
        out += fmt::format(
            "{}'runs.csv' using (column('seconds')):((strcol('problem') eq '{}') && (column('end') == {:g}) && "
            "(strcol('library') eq '{}') && (strcol('method') eq '{}') && (strcol('failure') eq '') ? column('error') "
            ": NaN) with linespoints pointtype 7 pointsize 0.4 {} title '{}'",
            separator, found.problem.name, study.end, method.library, method.name,
            is_ours(method) ? "dashtype 1" : "dashtype 2", full_name(method));
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
  int wins = 0;
  int comparisons = 0;
  std::string short_of;
  const auto count = [&](const Findings& found, const Study& study, const Comparison& c) {
    if (!c.they_arrive() && !c.we_arrive()) return;
    ++comparisons;
    if (c.reached()) {
      ++wins;
    } else {
      short_of += fmt::format("| {} | {:g} | {} | {:g} |\n", found.problem.title, study.end, row(found, c), c.wanted);
    }
  };
  std::string marked =
      "| | T | error | ours | by | theirs | by | their time over ours | | wanted "
      "|\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Findings& found : all)
    for (const Study& study : found.studies)
      for (const double level : error_levels(study)) {
        count(found, study, against_best(found, study, level));
        for (const Mark& mark : marks) {
          if (found.problem.name != mark.problem) continue;
          const Comparison c = against(mark, found, study, level);
          if (!c.they_arrive()) continue;
          marked += fmt::format("| {} | {:g} | {} | {:g} |\n", found.problem.title, study.end, row(found, c), c.wanted);
        }
      }
  std::string out =
      fmt::format("Of {} comparisons with the best of the others {} reach what is wanted.", comparisons, wins);
  if (!short_of.empty())
    out +=
        " These do not:\n\n| | T | error | ours | by | best other | by | their time over ours | | wanted |\n"
        "|---|---|---|---|---|---|---|---|---|---|\n" +
        short_of;
  return out + "\nAgainst MuJoCo's RK4, at the errors that it reaches:\n\n" + marked;
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
  std::vector<std::string> names = pictures;
  names.insert(names.begin(), {"runs.csv", "figures.gp"});
  std::vector<const char*> files;
  for (const std::string& name : names) files.push_back(name.c_str());
  lagroid::app::write_whole(docs / "peers", files, [&](const std::filesystem::path& staging) {
    lagroid::app::write_text(runs_csv(all), staging / "runs.csv");
    lagroid::app::write_text(figures(all), staging / "figures.gp");
    if (const std::string reason = lagroid::app::run_gnuplot(staging, "figures.gp", pictures); !reason.empty())
      throw std::runtime_error(reason);
    return names;
  });
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
