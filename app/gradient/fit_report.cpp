#include "fit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace lagroid::app {

namespace {

std::string line_of(const Fit::Unknown& unknown, std::size_t width) {
  std::string deviation = std::isfinite(unknown.deviation) ? fmt::format("{:.3g}", unknown.deviation) : "not told";
  return fmt::format("  {:{}}  {:20.12g}  {:>12}  {:14.6g}{}\n", unknown.name, width, unknown.value, deviation,
                     unknown.start, unknown.at_bound ? "  at its bound" : "");
}

}  // namespace

std::string text_of(const Fit& fit) {
  std::string out = fmt::format("{}: fitted to {} numbers of {} run{}: {} after {} iterations\n\n", fit.system,
                                fit.points.size(), fit.runs, fit.runs == 1 ? "" : "s", fit.status, fit.iterations);
  std::size_t width = 0;
  for (const Fit::Unknown& each : fit.unknowns) width = std::max(width, each.name.size());
  out += fmt::format("  {:{}}  {:>20}  {:>12}  {:>14}\n", "", width, "value", "deviation", "in the scene");
  for (const Fit::Unknown& each : fit.unknowns) out += line_of(each, width);
  for (const std::string& combination : fit.undetermined)
    out += fmt::format("  not told by these data: {}\n", combination);
  if (fit.unknowns.size() > 1) {
    out += "\n  correlations\n";
    for (std::size_t i = 0; i < fit.unknowns.size(); ++i) {
      out += fmt::format("  {:{}}", fit.unknowns[i].name, width);
      for (std::size_t k = 0; k <= i; ++k) {
        const double sizes = fit.unknowns[i].deviation * fit.unknowns[k].deviation;
        const double between = fit.covariance(Eigen::Index(i), Eigen::Index(k));
        out += std::isfinite(sizes) && sizes > 0 ? fmt::format("  {:7.4f}", between / sizes) : "        -";
      }
      out += "\n";
    }
  }
  out += fmt::format("\n  what is left over: {:.4g} sigma, root mean square\n", fit.scale);
  for (const Fit::Column& each : fit.columns)
    out += fmt::format("  {:{}}  {:.4g} over {} numbers; each goes with the next by {:.2f}: {}\n", each.name, width,
                       each.rms, each.count, each.correlation,
                       each.exact() ? "rounding"
                       : each.white ? "as independent errors do"
                                    : "not as independent errors do, the model is another or the errors are");
  if (!fit.ignored.empty()) out += fmt::format("  ignored, no columns of the run: {}\n", fmt::join(fit.ignored, ", "));
  if (!fit.other_costs.empty())
    out += fmt::format("  cost {:.6g}; from other guesses {:.6g}\n", fit.cost, fmt::join(fit.other_costs, ", "));
  return out;
}

std::string json_of(const Fit& fit) {
  using Json = nlohmann::ordered_json;
  const auto finite = [](double x) { return std::isfinite(x) ? Json(x) : Json(); };
  Json out = {{"system", fit.system}, {"status", fit.status}, {"message", fit.failure}, {"runs", fit.runs}};
  if (!fit.failure.empty()) return out.dump(2);
  out["iterations"] = fit.iterations;
  out["cost"] = fit.cost;
  out["other_costs"] = Json::array();
  for (const double each : fit.other_costs) out["other_costs"].push_back(finite(each));
  out["scale"] = fit.scale;
  out["unknowns"] = Json::array();
  for (const Fit::Unknown& each : fit.unknowns)
    out["unknowns"].push_back({{"name", each.name},
                               {"value", each.value},
                               {"deviation", finite(each.deviation)},
                               {"in_the_scene", each.start},
                               {"at_bound", each.at_bound}});
  out["covariance"] = Json::array();
  for (Eigen::Index i = 0; i < fit.covariance.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index k = 0; k < fit.covariance.cols(); ++k) row.push_back(fit.covariance(i, k));
    out["covariance"].push_back(row);
  }
  out["undetermined"] = fit.undetermined;
  out["columns"] = Json::array();
  for (const Fit::Column& each : fit.columns)
    out["columns"].push_back({{"name", each.name},
                              {"count", each.count},
                              {"rms", each.rms},
                              {"correlation", each.correlation},
                              {"white", each.white}});
  out["ignored"] = fit.ignored;
  return out.dump(2);
}

std::string csv_of(const Fit& fit) {
  std::string out = "run,t,column,measured,predicted,residual\n";
  for (const Fit::Point& each : fit.points)
    out += fmt::format("{},{},{},{},{},{}\n", each.run + 1, each.time, fit.columns[each.column].name, each.measured,
                       each.predicted, each.measured - each.predicted);
  return out;
}

}  // namespace lagroid::app
