#include "recorded_control.hpp"

#include "acting.hpp"
#include "row_words.hpp"

#include <lagroid/run/reports/report.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace lagroid::app {

namespace {

using OrderedJson = nlohmann::ordered_json;

/// As `components` are joined in a file: a unit for each column.
std::string joined(const std::vector<std::string>& units) { return fmt::format("{}", fmt::join(units, ", ")); }

std::vector<double> flat(const std::vector<std::vector<double>>& rows) {
  std::vector<double> out;
  for (const auto& row : rows) out.insert(out.end(), row.begin(), row.end());
  return out;
}

OrderedJson bands(const ControlResult& found, const std::vector<StageRange>& ranges) {
  OrderedJson out = OrderedJson::array();
  for (const StageRange& each : ranges) out.push_back({found.times[each.first], found.times[each.end]});
  return out;
}

/// The bounds of controls that are finite, in the time of their phase.
OrderedJson levels(const ControlResult& found) {
  OrderedJson out = OrderedJson::array();
  const auto add = [&](const std::vector<double>& bounds, double from, double to) {
    for (const double bound : bounds)
      if (std::isfinite(bound)) out.push_back({{"value", bound}, {"from", from}, {"to", to}});
  };
  if (found.phases.empty()) {
    add(found.lower, found.times.front(), found.times.back());
    add(found.upper, found.times.front(), found.times.back());
  }
  double begin = 0;
  for (const PhaseResult& each : found.phases) {
    add(each.lower, begin, begin + each.duration);
    add(each.upper, begin, begin + each.duration);
    begin += each.duration;
  }
  return out;
}

/// A panel for each unit, in the order in which they come.
std::vector<Panel> panels_by_unit(const std::string& title, const std::vector<std::string>& names,
                                  const std::vector<std::string>& units) {
  std::vector<Panel> out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string heading = units[i] == "1" ? title : fmt::format("{}, {}", title, units[i]);
    auto panel = std::find_if(out.begin(), out.end(), [&](const Panel& each) { return each.title == heading; });
    if (panel == out.end()) panel = out.insert(out.end(), Panel{heading, "t", units[i], "t", {}});
    panel->curves.push_back(names[i]);
  }
  return out;
}

bool has(const std::vector<std::string>& names, const char* name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

RunResult recorded(const ControlResult& found) {
  RunResult out;
  out.system = found.problem;
  out.status = to_string(found.report.status);
  out.trajectory.time = found.times;
  std::vector<Columns>& series = out.trajectory.series;
  series.push_back(
      {"states", found.states, joined(found.state_units), "state at the nodes", false, flat(found.state_rows)});
  series.insert(series.end(), found.seen.begin(), found.seen.end());
  const auto add_of_arrows = [&](const char* name, const std::vector<std::string>& columns, const std::string& unit,
                                 const char* meaning, const std::vector<std::vector<double>>& rows) {
    if (!rows.empty() && !columns.empty()) series.push_back({name, columns, unit, meaning, true, flat(rows)});
  };
  add_of_arrows("controls", found.controls, joined(found.control_units), "control over the arrow", found.control_rows);
  std::vector<std::string> names;
  std::vector<std::string> units;
  for (const CostateColumn& each : costate_columns(found)) {
    names.push_back(each.name);
    units.push_back(each.unit);
  }
  add_of_arrows("costates", names, joined(units), "multiplier of the arrow's equation, sign of l + <lambda, phi>",
                found.costate_rows);
  return out;
}

nlohmann::ordered_json picture_of(const ControlResult& found) {
  OrderedJson panels = OrderedJson::array();
  const OrderedJson acts = bands(found, where_inequalities_act(found));
  const auto add = [&](const Panel& panel, const OrderedJson& shaded, bool steps, const OrderedJson& lines) {
    OrderedJson& out = panels.emplace_back(panel_json(panel));
    out["bands"] = shaded;
    out["steps"] = steps;
    out["levels"] = lines;
  };
  if (has(found.states, "x") && has(found.states, "y"))
    add({"path", "x", "y", "x", {"y"}, true}, OrderedJson::array(), false, OrderedJson::array());
  for (const Panel& panel : panels_by_unit("state", found.states, found.state_units))
    add(panel, acts, false, OrderedJson::array());
  if (!found.control_rows.empty()) {
    add({"controls", "t", "u", "t", found.controls}, bands(found, where_bounds_are_reached(found)), true,
        levels(found));
    std::vector<std::string> costates;
    for (std::size_t i = 0; i < found.equations.size() && !found.costate_rows.empty(); ++i)
      costates.push_back(found.equations[i].costate);
    if (!costates.empty()) add({"costates", "t", "lambda", "t", costates}, acts, true, OrderedJson::array());
  }
  OrderedJson shapes = OrderedJson::array();
  for (const Shape& each : found.shapes) shapes.push_back(shape_json(each));
  return {{"shapes", shapes}, {"panels", panels}};
}

}  // namespace lagroid::app
