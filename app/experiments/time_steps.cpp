#include "time_steps.hpp"

#include <lagroid/core/capabilities/discrete_energy.hpp>
#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/solvers/integrators/integrator.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <set>

namespace lagroid::app {

const std::vector<const char*> time_report_files{"report.md",        "runs.csv",          "steps.csv",
                                                 "figures.gp",       "cost_kepler.svg",   "cost_pendulum.svg",
                                                 "steps_kepler.svg", "steps_pendulum.svg"};

namespace {

template <class Sys> struct Problem {
  std::string name;
  Sys system;
  State<typename Sys::GroupoidType> start;
  double end;  ///< time
};

Problem<Kepler> kepler() {
  constexpr double e = 0.9;
  // From the far end of the orbit, where steps are long.
  return {"kepler", {}, {{-1 - e, 0}, {0, -std::sqrt((1 - e) / (1 + e))}}, 20 * std::numbers::pi};
}
Problem<Pendulum> pendulum() { return {"pendulum", {}, {Vector<double, 1>(0.0), Vector<double, 1>(2.1)}, 20}; }

struct Method {
  std::string name;
  IntegratorOptions options;
  Quadrature quadrature;
};
Method fixed(std::string name, const Composition& composition, bool splitting) {
  Method method{std::move(name), {}, Quadrature::trapezoid};
  method.options.composition = composition;
  if (splitting) method.options.fixed = StepKind::splitting;
  return method;
}
Method varying(std::string name, TimeMode mode, Quadrature quadrature) {
  Method method{std::move(name), {}, quadrature};
  method.options.mode = mode;
  method.options.without_root = WithoutRoot::controlled;
  return method;
}

const std::vector<Method>& methods() {
  static const std::vector<Method> all{fixed("fixed", compositions::single, false),
                                       fixed("fixed order 4", compositions::suzuki, false),
                                       fixed("fixed order 6", compositions::kahan_li_6, false),
                                       fixed("fixed order 8", compositions::kahan_li_8, false),
                                       fixed("splitting", compositions::single, true),
                                       fixed("splitting order 8", compositions::kahan_li_8, true),
                                       varying("adaptive", TimeMode::adaptive, Quadrature::midpoint),
                                       varying("controlled", TimeMode::controlled, Quadrature::trapezoid)};
  return all;
}

template <class Sys> TimeRun run(const Problem<Sys>& problem, const Method& method, double first_step) {
  TimeRun out{problem.name, method.name, first_step, 0, 0, 0, 0, 0, 0, "converged"};
  Sys system = problem.system;
  system.h = first_step;
  system.quadrature = method.quadrature;
  const double energy = system.energy(problem.start);
  std::vector<double> seconds;
  constexpr long most_steps = 200000;
  constexpr double long_run = 0.3;  // s: timed once
  for (int repetition = 0; repetition < 3 && (repetition == 0 || seconds.front() < long_run); ++repetition) {
    const auto integrator =
        make_integrator(system, problem.start, system.groupoid.unit(problem.start.object), method.options);
    const int stages = integrator->traits().stages;
    out.evaluations = 0;
    out.energy_error = 0;
    const auto start = std::chrono::steady_clock::now();
    while (integrator->point().time < problem.end - 1e-9) {
      const StepReport report = integrator->advance();
      if (!report.converged() || integrator->point().index > most_steps) {
        out.status = report.converged() ? "too many steps" : std::string(to_string(report.status));
        break;
      }
      out.evaluations += stages > 0 ? stages : report.iterations;
      out.energy_error = std::max(out.energy_error, std::abs(system.energy(integrator->point().state) - energy));
    }
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    if (repetition > 0) continue;
    const auto& p = integrator->point();
    const auto exact = system.reference(problem.start, p.time);
    out.error = (p.state.object - exact.object).norm() + (p.state.momentum - exact.momentum).norm();
    out.steps = p.index;
    out.without_root = integrator->without_root();
  }
  std::sort(seconds.begin(), seconds.end());
  out.seconds = seconds[seconds.size() / 2];
  return out;
}

/// Step sizes and energy along one trajectory of each mode.
template <class Sys>
void sample(const Problem<Sys>& problem, const Method& method, double first_step, double end,
            std::vector<TimeSample>& out) {
  Sys system = problem.system;
  system.h = first_step;
  system.quadrature = method.quadrature;
  const bool adaptive = method.options.mode == TimeMode::adaptive;
  const auto integrator =
      make_integrator(system, problem.start, system.groupoid.unit(problem.start.object), method.options);
  const double energy = system.energy(problem.start);
  double first = 0;
  std::vector<TimeSample> all;
  while (integrator->point().time < end && integrator->advance().converged()) {
    const auto& p = integrator->point();
    const double discrete = discrete_energy(system, p.step, p.time - p.step_size, p.step_size);
    if (p.index == 1) first = discrete;
    all.push_back({problem.name, method.name, p.time, p.step_size,
                   std::abs(adaptive ? discrete - first : system.energy(p.state) - energy)});
  }
  constexpr std::size_t most = 800;  // as many as a picture shows
  const std::size_t stride = all.size() / most + 1;
  for (std::size_t j = 0; j < all.size(); j += stride) out.push_back(all[j]);
}

template <class Sys>
void study(const Problem<Sys>& problem, double coarse_fixed, double coarse_varying, int refinements,
           TimeFindings& findings, const std::function<void()>& done) {
  for (const auto& method : methods())
    for (int i = 0; i < refinements; ++i) {
      const double coarse = method.options.mode == TimeMode::fixed
                                ? coarse_fixed * std::sqrt(double(method.options.composition.stages()))
                                : coarse_varying;
      findings.runs.push_back(run(problem, method, coarse * std::pow(0.5, i)));
      done();
    }
}

const Method& method_named(const std::string& name) {
  return *std::find_if(methods().begin(), methods().end(), [&](const Method& m) { return m.name == name; });
}

std::vector<const TimeRun*> runs_of(const TimeFindings& findings, const std::string& problem,
                                    const std::string& method) {
  std::vector<const TimeRun*> out;
  for (const auto& run : findings.runs)
    if (run.problem == problem && run.method == method && run.status == "converged") out.push_back(&run);
  std::sort(out.begin(), out.end(), [](const TimeRun* a, const TimeRun* b) { return a->evaluations < b->evaluations; });
  return out;
}

std::string runs_csv(const TimeFindings& findings) {
  std::string out = "problem,method,first_step,steps,evaluations,seconds,error,energy_error,without_root,status\n";
  for (const auto& r : findings.runs)
    out += fmt::format("{},\"{}\",{:.6g},{},{},{:.4g},{:.4g},{:.4g},{},{}\n", r.problem, r.method, r.first_step,
                       r.steps, r.evaluations, r.seconds, r.error, r.energy_error, r.without_root, r.status);
  return out;
}
std::string steps_csv(const TimeFindings& findings) {
  std::string out = "problem,mode,t,h,energy_error\n";
  for (const auto& s : findings.samples)
    out += fmt::format("{},{},{:.8g},{:.8g},{:.4g}\n", s.problem, s.mode, s.time, s.step, s.energy_error);
  return out;
}

std::string figures(const TimeFindings& findings) {
  std::string out = "set datafile separator ','\nset grid\nset autoscale xfix\n";
  for (const std::string problem : {"kepler", "pendulum"}) {
    out += fmt::format(
        "set terminal svg size 1000,560 background 'white' noenhanced font ',11'\nset output 'cost_{}.svg'\n"
        "set multiplot layout 1,2\nset logscale xy\nset format '%.0e'\nset key below\n",
        problem);
    for (const auto& [column, label] : {std::pair("seconds", "time, s"), std::pair("evaluations", "evaluations")}) {
      out += fmt::format("set xlabel '{}'\nset ylabel 'error of the state at the end'\nset title '{}'\nplot ", label,
                         problem);
      bool first = true;
      for (const auto& method : methods()) {
        out += fmt::format(
            "{}'runs.csv' using (column('{}')):((strcol('problem') eq '{}') && (strcol('method') eq '{}') && "
            "(strcol('status') eq 'converged') ? column('error') : NaN) with linespoints pointtype 7 pointsize 0.5 "
            "title '{}'",
            first ? "" : ", ", column, problem, method.name, method.name);
        first = false;
      }
      out += "\n";
    }
    out += fmt::format(
        "unset multiplot\nset output 'steps_{}.svg'\nset multiplot layout 1,2\nunset logscale\nset format '%g'\n"
        "set logscale y\nset xlabel 't'\nset format y '%.0e'\n",
        problem);
    for (const auto& [column, label] : {std::pair("h", "step size"), std::pair("energy_error", "energy error")}) {
      out += fmt::format("set ylabel '{}'\nset title '{}: {}'\nplot ", label, problem, label);
      bool first = true;
      for (const std::string mode : {"fixed", "adaptive", "controlled"}) {
        out += fmt::format(
            "{}'steps.csv' using (column('t')):((strcol('problem') eq '{}') && (strcol('mode') eq '{}') && "
            "(column('{}') > 0) ? column('{}') : NaN) with points pointtype 7 pointsize 0.3 title '{}'",
            first ? "" : ", ", problem, mode, column, column, mode);
        first = false;
      }
      out += "\n";
    }
    out += "unset multiplot\nunset logscale\n";
  }
  out += fmt::format("# {} runs\n", findings.runs.size());
  return out;
}

std::string report(const TimeFindings& findings, const std::string& command, bool pictures) {
  std::string out = fmt::format(
      "# What accuracy costs: fixed, adaptive and controlled steps\n\nWritten by\n\n    {}\n\n"
      "Error of (q, p) at the end, against the continuous solution at the time reached; evaluations are gradients of "
      "the discrete Lagrangian (Newton's iterations), for splittings Strang steps; seconds are medians of three runs, "
      "of those over 0.3 s "
      "one run, "
      "and depend on the machine. *Fixed* steps are Stormer-Verlet as an implicit discrete Lagrangian step, and its "
      "compositions; *splitting* is the same method explicitly. *Adaptive* steps keep the discrete energy of the "
      "midpoint rule, and take controlled sizes where no step does (the last column counts these); *controlled* ones "
      "follow the time scale of the system. Runs that did not reach the end have a status, and their error is that at "
      "the time they reached.\n",
      command);
  for (const std::string problem : {"kepler", "pendulum"}) {
    out += problem == "kepler" ? "\n## Kepler, e = 0.9, ten revolutions\n\n" : "\n## A pendulum through its top\n\n";
    if (pictures)
      out += fmt::format(
          "![error over time and evaluations](cost_{0}.svg)\n\n![step sizes and energy](steps_{0}.svg)\n\n", problem);
    out += "| method | error of fixed steps at equal evaluations, over theirs |\n|---|---|\n";
    for (const auto& method : methods()) {
      if (method.name == "fixed") continue;
      const double gain = gain_at_equal_cost(findings, problem, method.name);
      out += gain > 0 ? fmt::format("| {} | {:.3g} |\n", method.name, gain)
                      : fmt::format("| {} | no run at a cost of theirs |\n", method.name);
    }
    out +=
        "\n| method | first step | steps | evaluations | seconds | error | energy error | without root | status |\n"
        "|---|---|---|---|---|---|---|---|---|\n";
    for (const auto& r : findings.runs) {
      if (r.problem != problem) continue;
      out += fmt::format("| {} | {:.3g} | {} | {} | {:.2g} | {:.2g} | {:.2g} | {} | {} |\n", r.method, r.first_step,
                         r.steps, r.evaluations, r.seconds, r.error, r.energy_error, r.without_root, r.status);
    }
  }
  return out;
}

}  // namespace

TimeFindings run_time_study(int refinements, const std::function<void(long, long)>& report) {
  TimeFindings findings;
  long count = 0;
  const long all = 2L * refinements * long(methods().size());
  const auto done = [&] { report(++count, all); };
  study(kepler(), 2 * std::numbers::pi / 500, 2 * std::numbers::pi / 40, refinements, findings, done);
  study(pendulum(), 0.1, 0.2, refinements, findings, done);
  for (const std::string mode : {"fixed", "adaptive", "controlled"}) {
    const bool fixed = mode == "fixed";
    sample(kepler(), method_named(mode), 2 * std::numbers::pi / (fixed ? 1000 : 160), 4 * std::numbers::pi,
           findings.samples);
    sample(pendulum(), method_named(mode), fixed ? 0.02 : 0.05, pendulum().end, findings.samples);
  }
  return findings;
}

double gain_at_equal_cost(const TimeFindings& findings, const std::string& problem, const std::string& method) {
  const auto fixed = runs_of(findings, problem, "fixed");
  std::vector<double> gains;
  for (const TimeRun* r : runs_of(findings, problem, method))
    for (std::size_t i = 0; i + 1 < fixed.size(); ++i) {
      const double from = std::log(double(fixed[i]->evaluations));
      const double to = std::log(double(fixed[i + 1]->evaluations));
      const double at = std::log(double(r->evaluations));
      if (at < from || at >= to || r->error <= 0) continue;
      const double s = (at - from) / (to - from);
      const double error = (1 - s) * std::log(fixed[i]->error) + s * std::log(fixed[i + 1]->error);
      gains.push_back(std::exp(error) / r->error);
    }
  if (gains.empty()) return 0;
  std::sort(gains.begin(), gains.end());
  return gains[gains.size() / 2];
}

std::vector<std::filesystem::path> write_time_report(const TimeFindings& findings, const std::string& command,
                                                     const std::filesystem::path& folder, std::string& note) {
  const auto data = [&](const std::filesystem::path& staging) {
    write_text(runs_csv(findings), staging / "runs.csv");
    write_text(steps_csv(findings), staging / "steps.csv");
    write_text(figures(findings), staging / "figures.gp");
    return std::vector<std::string>{"runs.csv", "steps.csv", "figures.gp"};
  };
  const Drawing drawing{"figures.gp",
                        {"cost_kepler.svg", "cost_pendulum.svg", "steps_kepler.svg", "steps_pendulum.svg"}};
  return write_and_draw(folder, time_report_files, data, drawing, note,
                        [&](const std::filesystem::path& staging, bool drawn) {
                          write_text(report(findings, command, drawn), staging / "report.md");
                          return std::vector<std::string>{"report.md"};
                        });
}

}  // namespace lagroid::app
