#include "poisson_study.hpp"

#include "../poisson/poisson_entry.hpp"
#include "../reading/kinds.hpp"

#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/solvers/status.hpp>

#include <fmt/format.h>

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
                                      {keys::toda_ring, {0.5, 0.7, 0.4, 0.3, -0.5, 0.2}},
                                      {keys::maxwell_bloch, {0.5, 1, -0.3}},
                                      {keys::sklyanin, {0.7, 0.4, -0.5, 0.6}},
                                      {keys::magnetic_particle, {0.3, -0.2, 0.4, 0.5, 0.1, -0.3}}};
  return all;
}

const PoissonEntry& entry_named(std::string_view name) {
  const auto& all = poisson_entries();
  return *std::find_if(all.begin(), all.end(), [&](const PoissonEntry& each) { return each.name == name; });
}

/// Where the motion is after two units of time; empty where a step failed.
std::vector<double> end_of(const AnyPoissonSystem& system, const std::vector<double>& start, std::string_view method,
                           int steps) {
  const auto motion = system.begin(start, {.method = std::string(method), .step = 2.0 / steps});
  for (int k = 0; k < steps; ++k)
    if (!motion->advance().converged()) return {};
  return motion->point();
}
double distance(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::quiet_NaN();
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
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
  row.order = fine > rounding ? std::log2(coarse / fine) : std::numeric_limits<double>::quiet_NaN();

  const auto motion = system.begin(start, {.method = std::string(method.name), .step = step_size});
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

std::string number(double x) { return std::isfinite(x) ? fmt::format("{:.2g}", x) : "-"; }
std::string order_of(const PoissonRow& row) {
  return std::isfinite(row.order) ? fmt::format("{:.2f}", row.order) : "-";
}
std::string casimirs_of(const PoissonRow& row) {
  return entry_named(row.system).casimirs.empty() ? "-" : number(row.casimir);
}

std::string report_of(const std::vector<PoissonRow>& rows, long steps, const std::string& command) {
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
  return out;
}

std::string csv_of(const std::vector<PoissonRow>& rows) {
  std::string out = "system,method,order,defect,casimir,energy_first,energy_last,microseconds,ended\n";
  for (const PoissonRow& row : rows)
    out += fmt::format("{},{},{},{},{},{},{},{},{}\n", row.system, row.method, row.order, row.defect, row.casimir,
                       row.energy_first, row.energy_last, row.microseconds, row.ended);
  return out;
}

}  // namespace

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

const std::vector<const char*> poisson_report_files{"report.md", "poisson.csv"};

std::vector<std::filesystem::path> write_poisson_report(const std::vector<PoissonRow>& rows, long steps,
                                                        const std::string& command, const std::filesystem::path& folder,
                                                        std::string& note) {
  const auto data = [&](const std::filesystem::path& staging) {
    write_text(csv_of(rows), staging / "poisson.csv");
    write_text(report_of(rows, steps, command), staging / "report.md");
    return std::vector<std::string>{"poisson.csv", "report.md"};
  };
  return write_and_draw(folder, poisson_report_files, data, {}, note);
}

}  // namespace lagroid::app
