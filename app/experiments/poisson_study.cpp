#include "poisson_study.hpp"

#include "../poisson/poisson_family.hpp"
#include "../reading/kinds.hpp"

#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/solvers/poisson/poisson_methods.hpp>
#include <lagroid/solvers/status.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <string_view>
#include <utility>

namespace lagroid::app {

namespace {

constexpr double step_size = 0.1;
constexpr long above_steps = 1000;

struct Start {
  std::string_view system;
  std::vector<double> state;
};
const std::vector<Start>& starts() {
  static const std::vector<Start> all{{keys::lotka_volterra, {2, 0.5}},
                                      {keys::three_species, {1, 1.9, 0.5}},
                                      {keys::volterra_ring, {1, 0.5, 0.8, 1.3, 0.4}},
                                      {keys::euler_top, {0.8, 0.6, 1.1}},
                                      {keys::kirchhoff, {0.4, 0.2, -0.6, 0.7, -0.1, 0.5}},
                                      {keys::heavy_top_bracket, {0, 0.1, 2, 0, 0.6, 0.8}},
                                      {keys::body_in_space, {0.4, 0.6, 1.1, 1, 0, 0, 0, 0.6, -0.8, 0, 0.8, 0.6}},
                                      {keys::spin_chain, {1, 0, 0, 0, 1, 0, 0.6, 0, 0.8}},
                                      {keys::toda_ring, {0.5, 0.7, 0.4, 0.3, -0.5, 0.2}},
                                      {keys::maxwell_bloch, {0.5, 1, -0.3}},
                                      {keys::sklyanin, {0.7, 0.4, -0.5, 0.6}},
                                      {keys::magnetic_particle, {0.3, -0.2, 0.4, 0.5, 0.1, -0.3}}};
  return all;
}

const PoissonEntry& entry_named(std::string_view name) {
  const auto& all = library_brackets().entries();
  return *std::find_if(all.begin(), all.end(), [&](const PoissonEntry& each) { return each.name == name; });
}

/// Where the motion is after two units of time; empty where a step failed.
std::vector<double> end_of(const AnyPoissonSystem& system, const std::vector<double>& start, std::string_view method,
                           int steps, double tolerance = 1e-12) {
  const auto motion = system.begin(start, {.method = std::string(method), .step = 2.0 / steps, .tolerance = tolerance});
  for (int k = 0; k < steps; ++k)
    if (!motion->advance().converged()) return {};
  return motion->point();
}
double distance(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::quiet_NaN();
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double off = std::abs(a[i] - b[i]);
    if (std::isnan(off)) return off;
    largest = std::max(largest, off);
  }
  return largest;
}

PoissonRow measured_row(const PoissonEntry& entry, const AnyPoissonSystem& system, const std::vector<double>& start,
                        const DeclaredMethod& method, long steps) {
  PoissonRow row;
  row.system = entry.name;
  row.method = method.name;
  const auto exact = end_of(system, start, "hamilton-jacobi-6", 320);
  const double coarse = distance(end_of(system, start, method.name, 20), exact);
  const double fine = distance(end_of(system, start, method.name, 40), exact);
  constexpr double rounding = 1e-13;
  row.order = fine > rounding && !poisson_methods::by_tolerance(method) ? std::log2(coarse / fine)
                                                                        : std::numeric_limits<double>::quiet_NaN();

  const auto motion = system.begin(start, {.method = std::string(method.name), .step = step_size, .tolerance = 1e-12});
  row.defect = motion->poisson_defect();
  const auto first = system.measure(start);
  const auto begun = std::chrono::steady_clock::now();
  std::chrono::steady_clock::duration looking{};
  for (long k = 0; k < steps; ++k) {
    const StepReport report = motion->advance();
    if (!report.converged()) {
      row.ended = fmt::format("step {}: {}", k + 1, to_string(report.status));
      break;
    }
    const auto look = std::chrono::steady_clock::now();
    const auto now = system.measure(motion->point());
    const double energy = std::abs(now[0].value - first[0].value);
    if (k < steps / 10) row.energy_first = std::max(row.energy_first, energy);
    if (k >= steps - steps / 10) row.energy_last = std::max(row.energy_last, energy);
    for (std::size_t i = 1; i < now.size(); ++i)
      row.casimir = std::max(row.casimir, std::abs(now[i].value - first[i].value));
    looking += std::chrono::steady_clock::now() - look;
  }
  const std::chrono::duration<double, std::micro> spent = std::chrono::steady_clock::now() - begun - looking;
  row.microseconds = spent.count() / double(steps);
  return row;
}

/// Of systems of which something is asked in the text: one in the plane, one of rotations, one of a lattice.
constexpr std::array<std::string_view, 3> systems_of_work{keys::lotka_volterra, keys::euler_top, keys::toda_ring};

PoissonWork measured_work(const PoissonEntry& entry, const AnyPoissonSystem& system, const std::vector<double>& start,
                          const DeclaredMethod& method, int steps, double tolerance, const std::vector<double>& exact) {
  PoissonWork out{entry.name, std::string(method.name), steps, tolerance, 0, std::numeric_limits<double>::infinity()};
  for (int repeat = 0; repeat < 9; ++repeat) {
    const auto begun = std::chrono::steady_clock::now();
    const auto end = end_of(system, start, method.name, std::max(steps, 1), tolerance);
    const std::chrono::duration<double, std::micro> spent = std::chrono::steady_clock::now() - begun;
    out.microseconds = std::min(out.microseconds, spent.count());
    out.error = distance(end, exact);
  }
  return out;
}

std::string number(double x) { return std::isfinite(x) ? fmt::format("{:.2g}", x) : "-"; }
std::string order_of(const PoissonRow& row) {
  return std::isfinite(row.order) ? fmt::format("{:.2f}", row.order) : "-";
}
std::string casimirs_of(const PoissonRow& row) {
  return entry_named(row.system).casimirs.empty() ? "-" : number(row.casimir);
}

/// What theory promises of noise, and what is found.
std::string noise_table(const std::vector<NoiseRow>& rows) {
  std::string out =
      "\n## Noise\n\nEuler's top with noise along its axes. Errors are standard errors, of orders by leaving out one "
      "batch of paths after another.\n\n| | theory | found | error | apart |\n|---|---|---|---|---|\n";
  for (const NoiseRow& row : rows)
    out += row.error > 0 ? fmt::format("| {} | {:.4g} | {:.4f} | {:.4f} | {:.1f} errors |\n", row.what, row.promised,
                                       row.found, row.error, std::abs(row.found - row.promised) / row.error)
                         : fmt::format("| {} | {:.4g} | {:.1e} | | rounding |\n", row.what, row.promised, row.found);
  return out;
}

/// Of each system, the cheapest method for some errors.
std::string work_table(const std::vector<PoissonWork>& work) {
  std::string out =
      "\n## Work against error\n\n![work against error](work.svg)\n\nMicroseconds for 2 s at the largest step with "
      "that "
      "error at most, of steps of 0.2 s and their halves, or at the largest of the tolerances 1e-3, 1e-4, ...; a dash "
      "where none had it.\n";
  constexpr std::array errors{1e-3, 1e-6, 1e-9};
  for (const std::string_view system : systems_of_work) {
    out += fmt::format("\n| {} | 1e-3 | 1e-6 | 1e-9 |\n|---|---|---|---|\n", system);
    std::vector<std::string> methods;
    for (const PoissonWork& each : work)
      if (each.system == system && std::find(methods.begin(), methods.end(), each.method) == methods.end())
        methods.push_back(each.method);
    for (const std::string& method : methods) {
      out += fmt::format("| {} |", method);
      for (const double error : errors) {
        double least = std::numeric_limits<double>::infinity();
        for (const PoissonWork& each : work)
          if (each.system == system && each.method == method && each.error <= error)
            least = std::min(least, each.microseconds);
        out += std::isfinite(least) ? fmt::format(" {:.3g} |", least) : " - |";
      }
      out += "\n";
    }
  }
  return out;
}

std::string work_script(const std::vector<PoissonWork>& work) {
  std::string out =
      "# Draws work.csv; run by lagroid, or by hand: gnuplot work.gp\n"
      "set datafile separator ','\nset grid\nset logscale xy\nset format '10^{%T}'\nset xlabel 'microseconds for 2 s'\n"
      "set ylabel 'error'\nset key outside right noenhanced\n";
  for (const auto& [file, terminal] : {std::pair("work.svg", "svg size 900,1100 background 'white'"),
                                       std::pair("work.png", "pngcairo size 900,1100")}) {
    out += fmt::format("\nset terminal {}\nset output '{}'\nset multiplot layout {},1\n", terminal, file,
                       systems_of_work.size());
    for (const std::string_view system : systems_of_work) {
      std::vector<std::string> curves;
      for (const PoissonWork& each : work) {
        const std::string curve = fmt::format(
            "'work.csv' using (strcol('system') eq '{}' && strcol('method') eq '{}' ? column('microseconds') : NaN):"
            "'error' with linespoints title '{}'",
            system, each.method, each.method);
        if (each.system == system && std::find(curves.begin(), curves.end(), curve) == curves.end())
          curves.push_back(curve);
      }
      out += fmt::format("set title '{}' noenhanced\nplot {}\n", system, fmt::join(curves, ", \\\n  "));
    }
    out += "unset multiplot\nset output\n";
  }
  return out;
}

std::string report_of(const PoissonFindings& found, long steps, const std::string& command) {
  const std::vector<PoissonRow>& rows = found.rows;
  std::string out = fmt::format(
      "# Integrators on Poisson manifolds\n\n"
      "    {}\n\n"
      "Every method of each system. Order: from errors after 2 s by steps of 0.1 and 0.05 s, against hamilton-jacobi-6 "
      "with 320 steps; a dash where the error is rounding. Defect: the largest entry of D pi D^T - pi of one step of "
      "{} s, over that of pi. Casimirs and energy: how far they go over {} such steps, the energy over the first and "
      "the last tenth.\n",
      command, step_size, steps);
  std::string_view system;
  for (const PoissonRow& row : rows) {
    if (row.system != system)
      out += fmt::format(
          "\n## {}\n\n| method | order | Poisson defect | Casimirs | energy, first tenth | last tenth | us a step |\n"
          "|---|---|---|---|---|---|---|\n",
          row.system);
    system = row.system;
    out += fmt::format("| {} | {} | {} | {} | {} | {} | {:.2g} |\n", row.method, order_of(row), number(row.defect),
                       casimirs_of(row), number(row.energy_first),
                       row.ended.empty() ? number(row.energy_last) : row.ended, row.microseconds);
  }
  out += work_table(found.work);
  if (!found.periods.empty()) out += periods_table(found.periods, found.period_count);
  out += above_table(found.above, above_steps);
  if (!found.noise.empty()) out += noise_table(found.noise);
  return out;
}

std::string csv_of(const std::vector<PoissonRow>& rows) {
  std::string out = "system,method,order,defect,casimir,energy_first,energy_last,microseconds,ended\n";
  for (const PoissonRow& row : rows)
    out += fmt::format("{},{},{},{},{},{},{},{},{}\n", row.system, row.method, row.order, row.defect, row.casimir,
                       row.energy_first, row.energy_last, row.microseconds, row.ended);
  return out;
}

std::string work_csv(const std::vector<PoissonWork>& work) {
  std::string out = "system,method,steps,tolerance,error,microseconds\n";
  for (const PoissonWork& each : work)
    out += fmt::format("{},{},{},{},{},{}\n", each.system, each.method, each.steps, each.tolerance, each.error,
                       each.microseconds);
  return out;
}
std::string noise_csv(const std::vector<NoiseRow>& rows) {
  std::string out = "what,theory,found,error\n";
  for (const NoiseRow& row : rows)
    out += fmt::format("\"{}\",{},{},{}\n", row.what, row.promised, row.found, row.error);
  return out;
}

}  // namespace

std::vector<PoissonWork> run_poisson_work(const std::function<void(long, long)>& report) {
  std::vector<PoissonWork> out;
  for (std::size_t i = 0; i < systems_of_work.size(); ++i) {
    const auto& start = *std::find_if(starts().begin(), starts().end(),
                                      [&](const Start& each) { return each.system == systems_of_work[i]; });
    const PoissonEntry& entry = entry_named(start.system);
    const auto system = entry.read(parse_scene(fmt::format("system = \"{}\"\n", entry.name), "poisson study", {}));
    const auto exact = end_of(*system, start.state, "hamilton-jacobi-6", 640);
    const auto add = [&](const DeclaredMethod& method, int steps, double tolerance) {
      PoissonWork work = measured_work(entry, *system, start.state, method, steps, tolerance, exact);
      work.error = std::max(work.error, 1e-16);  // of rounding, for logarithms
      if (std::isfinite(work.error)) out.push_back(std::move(work));
    };
    for (const DeclaredMethod* method : entry.methods) {
      if (poisson_methods::by_tolerance(*method)) {
        for (double tolerance = 1e-3; tolerance > 1e-14; tolerance *= 0.1) add(*method, 0, tolerance);
      } else {
        for (int steps = 10; steps <= 640; steps *= 2) add(*method, steps, 0);
      }
    }
    report(long(i) + 1, long(systems_of_work.size()));
  }
  return out;
}

std::vector<AboveRow> run_poisson_above() { return run_from_above(above_steps); }

std::vector<PoissonRow> run_poisson_study(long steps, const std::function<void(long, long)>& report) {
  long all = 0;
  for (const Start& start : starts()) all += long(entry_named(start.system).methods.size());
  std::vector<PoissonRow> rows;
  for (const Start& start : starts()) {
    const PoissonEntry& entry = entry_named(start.system);
    const auto system = entry.read(parse_scene(fmt::format("system = \"{}\"\n", entry.name), "poisson study", {}));
    for (const DeclaredMethod* method : entry.methods) {
      rows.push_back(measured_row(entry, *system, start.state, *method, steps));
      report(long(rows.size()), all);
    }
  }
  return rows;
}

std::string text_of(const PoissonRow& row) {
  return fmt::format("  {:<18} {:<20} order {:>4}, Poisson defect {:>8}, Casimirs within {:>8}\n", row.system,
                     row.method, order_of(row), number(row.defect), casimirs_of(row));
}

const std::vector<const char*> poisson_report_files{"report.md", "poisson.csv", "work.csv", "above.csv", "periods.csv",
                                                    "noise.csv", "work.gp",     "work.svg", "work.png"};

std::vector<std::filesystem::path> write_poisson_report(const PoissonFindings& found, long steps,
                                                        const std::string& command, const std::filesystem::path& folder,
                                                        std::string& note) {
  const auto data = [&](const std::filesystem::path& staging) {
    write_text(csv_of(found.rows), staging / "poisson.csv");
    write_text(work_csv(found.work), staging / "work.csv");
    write_text(above_csv(found.above), staging / "above.csv");
    write_text(periods_csv(found.periods), staging / "periods.csv");
    write_text(noise_csv(found.noise), staging / "noise.csv");
    write_text(work_script(found.work), staging / "work.gp");
    write_text(report_of(found, steps, command), staging / "report.md");
    return std::vector<std::string>{"poisson.csv", "work.csv", "above.csv", "periods.csv",
                                    "noise.csv",   "work.gp",  "report.md"};
  };
  return write_and_draw(folder, poisson_report_files, data, {"work.gp", {"work.svg", "work.png"}}, note);
}

}  // namespace lagroid::app
