#include "report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace lagroid::app {

namespace {

using Json = nlohmann::ordered_json;

Json json(const Endpoint& e) {
  Json out;
  out["position"] = e.position;
  if (e.attitude) out["attitude"] = *e.attitude;
  if (e.body_attitude) out["body_attitude"] = *e.body_attitude;
  out["momentum"] = e.momentum;
  return out;
}

Json json(const LedgerEntry& e) {
  Json out;
  out["name"] = e.name;
  out["promise"] = e.promise;
  out["verdict"] = e.verdict;
  out["drift"] = e.drift;
  out["relative_drift"] = e.relative_drift;
  if (e.bound > 0) out["bound"] = e.bound;
  if (!e.initial.empty()) {
    out["initial"] = e.initial;
    out["final"] = e.final;
  }
  return out;
}

std::string numbers(const std::vector<double>& v) { return fmt::format("({:.10g})", fmt::join(v, ", ")); }

std::string endpoint(const Endpoint& e) {
  std::string out;
  if (!e.position.empty()) out += fmt::format("position {}  ", numbers(e.position));
  if (e.attitude) out += fmt::format("attitude ({:.8g})  ", fmt::join(*e.attitude, ", "));
  return out + fmt::format("momentum {}", numbers(e.momentum));
}

/// The run as a whole: the solve and its files.
std::string run_status(const RunResult& r) { return r.output_error.empty() ? r.status : "output_failed"; }

std::string run_message(const RunResult& r) {
  return r.message + (r.message.empty() || r.output_error.empty() ? "" : "; ") + r.output_error;
}

/// The solver's own promise: every step, or the boundary value, solved within its iterations.
std::string solver_verdict(const RunResult& r) { return r.converged() ? "kept" : "BROKEN"; }

std::string solved(const RunResult& r) {
  if (r.converged()) return "every equation solved";
  return r.status == "no_minimum" ? "no minimum found" : "not every equation solved";
}

std::string kind(const Minimum& m) {
  std::string out = m.is_minimum ? "minimum" : fmt::format("saddle ({} descending)", m.negative_directions);
  if (!m.isolated) out += ", not isolated";
  if (!m.normal) out += ", abnormal";
  return out;
}

}  // namespace

std::string text_report(const RunResult& r) {
  std::string out;
  const auto line = [&](const std::string& text) { out += text + "\n"; };
  line(fmt::format("{}: {}, {} of {} steps in {:.3g} s", r.system, run_status(r), r.steps, r.steps_asked, r.seconds));
  if (const std::string message = run_message(r); !message.empty()) line("  " + message);
  if (r.cost) line(fmt::format("  cost      {:.15g}", *r.cost));
  if (!r.initial.momentum.empty()) {
    line("  initial   " + endpoint(r.initial));
    line("  final     " + endpoint(r.final));
  }
  if (r.final.body_attitude)
    line(fmt::format("            the ball itself, A^T: ({:.8g})", fmt::join(*r.final.body_attitude, ", ")));
  if (!r.minima.empty()) {
    line("  stationary paths");
    for (const auto& m : r.minima)
      line(fmt::format("    cost {:<18.12g} {}  initial momentum {}", m.cost, kind(m), numbers(m.momentum)));
  }
  for (const auto& note : r.notes) line("  note: " + note);
  line("  ledger");
  for (const auto& e : r.ledger.entries) {
    if (e.promise == "counted") {
      line(fmt::format("    {:<28} {:<9} {:.0f}, share {:.3g}", e.name, e.promise, e.drift, e.relative_drift));
      continue;
    }
    const std::string bound = e.bound > 0 ? fmt::format(" (bound {:.1e})", e.bound) : "";
    line(fmt::format("    {:<28} {:<9} drift {:.2e}, relative {:.2e}{}: {}", e.name, e.promise, e.drift,
                     e.relative_drift, bound, e.verdict));
  }
  line(fmt::format("    {:<28} mean {:.2f}, most {}: {}", "iterations", r.ledger.mean_iterations,
                   r.ledger.most_iterations, solver_verdict(r)));
  line(fmt::format("    {:<28} {}, status {}: {}", "solver", solved(r), r.status, solver_verdict(r)));
  return out;
}

std::string json_report(const RunResult& r) {
  Json out;
  out["system"] = r.system;
  out["status"] = run_status(r);
  if (const std::string message = run_message(r); !message.empty()) out["message"] = message;
  out["steps"] = r.steps;
  out["steps_asked"] = r.steps_asked;
  out["seconds"] = r.seconds;
  out["iterations"] = r.iterations;
  if (r.cost) out["cost"] = *r.cost;
  if (r.residual) out["residual"] = *r.residual;
  out["initial"] = json(r.initial);
  out["final"] = json(r.final);
  out["multipliers"] = {{"first", r.first_multipliers}, {"last", r.last_multipliers}};
  Json minima = Json::array();
  for (const auto& m : r.minima)
    minima.push_back({{"cost", m.cost},
                      {"momentum", m.momentum},
                      {"is_minimum", m.is_minimum},
                      {"isolated", m.isolated},
                      {"normal", m.normal},
                      {"negative_directions", m.negative_directions}});
  out["minima"] = minima;
  Json ledger;
  Json entries = Json::array();
  for (const auto& e : r.ledger.entries) entries.push_back(json(e));
  ledger["entries"] = entries;
  ledger["iterations"] = {
      {"mean", r.ledger.mean_iterations}, {"max", r.ledger.most_iterations}, {"verdict", solver_verdict(r)}};
  ledger["solver"] = {{"status", r.status}, {"verdict", solver_verdict(r)}};
  out["ledger"] = ledger;
  out["notes"] = r.notes;
  return out.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string json_error(const std::string& status, const std::string& message) {
  return Json{{"status", status}, {"message", message}}.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace lagroid::app
