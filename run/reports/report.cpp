#include <lagroid/run/reports/markup.hpp>
#include <lagroid/run/reports/report.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace lagroid {

namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson json(const Endpoint& e) {
  OrderedJson out;
  out["time"] = e.time;
  out["position"] = e.position;
  if (e.attitude) out["attitude"] = *e.attitude;
  if (e.body_attitude) out["body_attitude"] = *e.body_attitude;
  out["momentum"] = e.momentum;
  return out;
}

OrderedJson json(const LedgerEntry& e) {
  OrderedJson out;
  out["name"] = e.name;
  out["promise"] = e.promise;
  out["verdict"] = e.verdict;
  if (!e.reason.empty()) out["reason"] = e.reason;
  out["drift"] = e.drift;
  out["relative_drift"] = e.relative_drift;
  if (e.bound > 0) out["bound"] = e.bound;
  if (!e.initial.empty()) {
    out["initial"] = e.initial;
    out["final"] = e.final;
  }
  return out;
}

OrderedJson json(const Coordinate& c) {
  return std::visit([](const auto& value) { return OrderedJson(value); }, c);
}

OrderedJson json(const std::vector<Coordinate>& coordinates) {
  OrderedJson out = OrderedJson::array();
  for (const auto& c : coordinates) out.push_back(json(c));
  return out;
}

OrderedJson json(const Shape& s) {
  OrderedJson turns = OrderedJson::array();
  for (const auto& turn : s.turns)
    turns.push_back({{"axis", turn.axis}, {"angle", json(turn.angle)}, {"rate", turn.rate}});
  return {{"kind", s.kind},         {"size", s.size},   {"position", json(s.position)},
          {"attitude", s.attitude}, {"turns", turns},   {"transposed", s.transposed},
          {"offset", s.offset},     {"to", json(s.to)}, {"trail", s.trail}};
}

/// `panels_of` reads it.
OrderedJson json(const Panel& p) {
  return {{"title", p.title},   {"x_label", p.x_label},       {"y_label", p.y_label},   {"x", p.x},
          {"curves", p.curves}, {"equal_axes", p.equal_axes}, {"x_offset", p.x_offset}, {"y_offset", p.y_offset}};
}

/// `events_of` reads all but the rows.
OrderedJson json(const EventTable& events) {
  OrderedJson watched = OrderedJson::array();
  for (std::size_t i = 0; i < events.watched.size(); ++i) {
    const WatchedEvent& event = events.watched[i];
    OrderedJson each{{"name", event.name}, {"when", event.when}, {"count", event.count}, {"touches", event.touches}};
    if (const auto span = span_of(events, i)) {
      each["first"] = span->first;
      each["last"] = span->last;
      if (event.count > 1) {
        each["mean_interval"] = span->mean_interval;
        each["mean_interval_error"] = span->error;
      }
    }
    if (!event.plot.empty()) each["plot"] = event.plot;
    watched.push_back(std::move(each));
  }
  OrderedJson rows = OrderedJson::array();
  for (const Happening& row : events.rows)
    rows.push_back({{"event", events.watched[row.event].name},
                    {"t", row.time},
                    {"t_error", row.time_error},
                    {"step", row.step},
                    {"passing", to_string(row.passing)},
                    {"together", row.together},
                    {"values", row.values}});
  return {{"watched", watched}, {"columns", events.columns}, {"rows", rows}};
}

template <class T> OrderedJson array_of(const std::vector<T>& items) {
  OrderedJson out = OrderedJson::array();
  for (const auto& item : items) out.push_back(json(item));
  return out;
}

std::string numbers(const std::vector<double>& v) { return fmt::format("({:.10g})", fmt::join(v, ", ")); }

std::string endpoint(const Endpoint& e) {
  std::string out = fmt::format("t {:.8g}  ", e.time);
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
std::string solver_verdict(const RunResult& r) { return r.converged() || r.interrupted() ? "kept" : "BROKEN"; }

std::string solved(const RunResult& r) {
  if (r.converged() || r.interrupted()) return "every equation solved";
  return r.status == "no_minimum" ? "no minimum found" : "not every equation solved";
}

std::string kind(const StationaryPath& path) {
  std::string out = path.is_minimum ? "minimum" : fmt::format("saddle ({} descending)", path.negative_directions);
  if (!path.isolated) out += ", not isolated";
  if (!path.normal) out += ", abnormal";
  return out;
}

}  // namespace

nlohmann::ordered_json panel_json(const Panel& panel) { return json(panel); }
nlohmann::ordered_json shape_json(const Shape& shape) { return json(shape); }

std::string text_report(const RunResult& r) {
  std::string out;
  const auto line = [&](const std::string& text) { out += text + "\n"; };
  line(fmt::format("{}: {}, {} of {} steps in {:.3g} s", r.system, run_status(r), r.steps, r.steps_asked, r.seconds));
  if (const std::string message = run_message(r); !message.empty()) line("  " + message);
  if (!r.method.empty()) line("  method    " + r.method);
  if (r.cost) line(fmt::format("  cost      {:.15g}", *r.cost));
  constexpr std::size_t readable = 9;  // numbers; of scenes with more the summary tells
  if (!r.initial.momentum.empty() && r.initial.momentum.size() <= readable) {
    line("  initial   " + endpoint(r.initial));
    line("  final     " + endpoint(r.final));
  }
  if (r.final.body_attitude)
    line(fmt::format("            the ball itself, A^T: ({:.8g})", fmt::join(*r.final.body_attitude, ", ")));
  if (!r.stationary_paths.empty()) {
    line("  stationary paths");
    for (const auto& path : r.stationary_paths)
      line(fmt::format("    cost {:<18.12g} {}  found by {} of {} starts  initial momentum {}", path.cost, kind(path),
                       path.starts, r.starts, numbers(path.momentum)));
  }
  for (const auto& note : r.notes) line("  note: " + note);
  for (std::size_t i = 0; i < r.events.watched.size(); ++i)
    if (const auto span = span_of(r.events, i)) {
      const WatchedEvent& event = r.events.watched[i];
      line(fmt::format("  event \"{}\": {} times, first at t {:.10g}, last at {:.10g}{}", event.name, event.count,
                       span->first, span->last,
                       event.count > 1 ? fmt::format(", mean interval {:.10g}", span->mean_interval) : ""));
    }
  line("  ledger");
  for (const auto& e : r.ledger.entries) {
    if (e.promise == "counted") {
      line(fmt::format("    {:<28} {:<9} {:.0f}, share {:.3g}", e.name, e.promise, e.drift, e.relative_drift));
      continue;
    }
    const std::string bound = e.bound > 0 ? fmt::format(" (bound {:.1e})", e.bound) : "";
    const std::string reason = e.reason.empty() ? "" : fmt::format(" ({})", e.reason);
    line(fmt::format("    {:<28} {:<9} drift {:.2e}, relative {:.2e}{}: {}{}", e.name, e.promise, e.drift,
                     e.relative_drift, bound, e.verdict, reason));
  }
  line(fmt::format("    {:<28} mean {:.2f}, most {}: {}", "iterations", r.ledger.mean_iterations,
                   r.ledger.most_iterations, solver_verdict(r)));
  line(fmt::format("    {:<28} {}, status {}: {}", "solver", solved(r), r.status, solver_verdict(r)));
  return out;
}

std::string json_report(const RunResult& r) {
  OrderedJson out;
  out["system"] = r.system;
  out["status"] = run_status(r);
  if (!r.method.empty()) out["method"] = r.method;
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
  if (r.starts > 0) out["starts"] = r.starts;
  OrderedJson paths = OrderedJson::array();
  for (const auto& path : r.stationary_paths)
    paths.push_back({{"cost", path.cost},
                     {"starts", path.starts},
                     {"momentum", path.momentum},
                     {"is_minimum", path.is_minimum},
                     {"isolated", path.isolated},
                     {"normal", path.normal},
                     {"negative_directions", path.negative_directions}});
  out["stationary_paths"] = paths;
  OrderedJson ledger;
  ledger["entries"] = array_of(r.ledger.entries);
  ledger["iterations"] = {
      {"mean", r.ledger.mean_iterations}, {"max", r.ledger.most_iterations}, {"verdict", solver_verdict(r)}};
  ledger["solver"] = {{"status", r.status}, {"verdict", solver_verdict(r)}};
  out["ledger"] = ledger;
  if (!r.events.watched.empty()) out["events"] = json(r.events);
  out["notes"] = r.notes;
  out["picture"] = {{"shapes", array_of(r.shapes)}, {"panels", array_of(r.panels)}};
  return json_text(out);
}

std::vector<Panel> panels_of(const OrderedJson& summary) {
  std::vector<Panel> out;
  for (const OrderedJson& p : summary.at("picture").at("panels"))
    out.push_back({p.at("title"), p.at("x_label"), p.at("y_label"), p.at("x"), p.at("curves"), p.at("equal_axes"),
                   p.at("x_offset"), p.at("y_offset")});
  return out;
}

EventTable events_of(const OrderedJson& summary) {
  EventTable events;
  if (!summary.contains("events")) return events;
  const OrderedJson& table = summary.at("events");
  events.columns = table.at("columns").get<std::vector<std::string>>();
  for (const OrderedJson& each : table.at("watched")) {
    WatchedEvent event{each.at("name"), each.at("when"), {}, each.at("count"), each.at("touches")};
    if (each.contains("plot")) event.plot = each.at("plot").get<std::vector<std::string>>();
    events.watched.push_back(std::move(event));
  }
  return events;
}

std::string json_error(const std::string& status, const std::string& message) {
  return json_text({{"status", status}, {"message", message}});
}

}  // namespace lagroid
