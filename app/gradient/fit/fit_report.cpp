#include "fit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace lagroid::app {

namespace {

std::string deviation_in_words(double deviation) {
  return std::isfinite(deviation) ? fmt::format("{:.3g}", deviation) : std::isnan(deviation) ? "not known" : "not told";
}

std::string counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string line_of(const Fit::Unknown& unknown, std::size_t width) {
  return fmt::format("  {:{}}  {:20.12g}  {:>12}  {:14.6g}{}\n", unknown.name, width, unknown.value,
                     unknown.at_bound ? "held" : deviation_in_words(unknown.deviation), unknown.start,
                     unknown.at_bound ? "  at its bound" : "");
}

nlohmann::ordered_json matrix_of(const Eigen::MatrixXd& a) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    nlohmann::ordered_json row = nlohmann::ordered_json::array();
    for (Eigen::Index k = 0; k < a.cols(); ++k) row.push_back(a(i, k));
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

std::string text_of(const Fit& fit) {
  std::string out =
      fmt::format("{}: fitted to {} of {}: {} after {}\n\n", fit.system, counted(fit.points.size(), "number"),
                  counted(fit.runs, "run"), fit.status, counted(std::size_t(fit.iterations), "iteration"));
  std::size_t width = 0;
  for (const Fit::Unknown& each : fit.unknowns) width = std::max(width, each.name.size());
  for (const Fit::Combination& each : fit.combinations) width = std::max(width, each.name.size());
  out += fmt::format("  {:{}}  {:>20}  {:>12}  {:>14}\n", "", width, "value", "deviation", "in the scene");
  for (const Fit::Unknown& each : fit.unknowns) out += line_of(each, width);
  for (const std::string& combination : fit.undetermined)
    out += fmt::format("  not told by these data: {}\n", combination);
  if (!fit.undetermined.empty())
    out += fmt::format("  they tell {} of {} combinations\n", fit.rank, fit.unknowns.size());
  if (!fit.combinations.empty()) out += "\n";
  for (const Fit::Combination& each : fit.combinations)
    out +=
        fmt::format("  {:{}}  {:20.12g}  {:>12}\n", each.name, width, each.value, deviation_in_words(each.deviation));
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
  out += std::isnan(fit.scale)
             ? "\n  as many numbers as unknowns: nothing is left over that would tell how large errors "
               "are but what --sigma says of all columns\n"
             : fmt::format("\n  what is left over: {:.4g} sigma, root mean square\n", fit.scale);
  constexpr long few = 10;
  for (const Fit::Column& each : fit.columns)
    out += fmt::format("  {:{}}  {:.4g} over {}; each goes with the next by {:.2f}: {}\n", each.name, width, each.rms,
                       counted(std::size_t(each.count), "number"), each.correlation,
                       each.exact()       ? "rounding"
                       : each.count < few ? "too few to tell anything by"
                       : each.white       ? "as independent errors do"
                                          : "not as independent errors do, the model is another or the errors are");
  if (!fit.left_out.empty())
    out += fmt::format("  not fitted, as --of can choose: {}\n", fmt::join(fit.left_out, ", "));
  if (!fit.ignored.empty())
    out += fmt::format("  ignored, for they are none of what a run is fitted by (more of it by --column): {}\n",
                       fmt::join(fit.ignored, ", "));
  for (const std::string& note : fit.notes) out += fmt::format("  note: {}\n", note);
  if (!fit.other_costs.empty())
    out += fmt::format("  cost {:.6g}; from other guesses {:.6g}\n", fit.cost, fmt::join(fit.other_costs, ", "));
  return out;
}

std::string json_of(const Fit& fit) {
  using OrderedJson = nlohmann::ordered_json;
  const auto finite = [](double x) { return std::isfinite(x) ? OrderedJson(x) : OrderedJson(); };
  OrderedJson out = {{"system", fit.system}, {"status", fit.status}, {"message", fit.failure}, {"runs", fit.runs}};
  if (!fit.failure.empty()) return out.dump(2);
  out["iterations"] = fit.iterations;
  out["cost"] = fit.cost;
  out["other_costs"] = OrderedJson::array();
  for (const double each : fit.other_costs) out["other_costs"].push_back(finite(each));
  out["scale"] = finite(fit.scale);
  out["unknowns"] = OrderedJson::array();
  for (const Fit::Unknown& each : fit.unknowns)
    out["unknowns"].push_back({{"name", each.name},
                               {"value", each.value},
                               {"deviation", finite(each.deviation)},
                               {"in_the_scene", each.start},
                               {"at_bound", each.at_bound}});
  out["covariance"] = matrix_of(fit.covariance);
  out["rank"] = fit.rank;
  out["singular_values"] = std::vector<double>(fit.singular_values.begin(), fit.singular_values.end());
  out["null_space"] = matrix_of(fit.null_space);
  out["undetermined"] = fit.undetermined;
  out["combinations"] = OrderedJson::array();
  for (const Fit::Combination& each : fit.combinations)
    out["combinations"].push_back(
        {{"name", each.name}, {"value", finite(each.value)}, {"deviation", finite(each.deviation)}});
  out["columns"] = OrderedJson::array();
  for (const Fit::Column& each : fit.columns)
    out["columns"].push_back({{"name", each.name},
                              {"count", each.count},
                              {"rms", each.rms},
                              {"correlation", each.correlation},
                              {"white", each.white}});
  out["ignored"] = fit.ignored;
  out["left_out"] = fit.left_out;
  if (!fit.notes.empty()) out["notes"] = fit.notes;
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
