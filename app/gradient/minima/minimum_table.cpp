#include "minimum_table.hpp"

#include "../checks/differences.hpp"
#include "../columns/table_lines.hpp"

#include <lagroid/solvers/optimisation/methods/trust_region.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

namespace lagroid::app {

namespace {

using optimisation::MinimumDerivatives, optimisation::MinimumStatus, optimisation::ParametricObjective,
    optimisation::entries_named;

/// The numbers of a point, as rows of a table.
optimisation::ParameterTable table_of_minimiser(const OptimisationScene& scene) {
  return {"minimiser", scene.instance.rows, scene.instance.columns};
}

/// Those that a word chooses, as places among what is observed.
std::vector<int> rows_of_minimum(const OptimisationScene& scene, const std::string& word) {
  if (word == "minimum") return {0};
  const auto point = table_of_minimiser(scene);
  std::vector<int> out;
  try {
    for (const auto& each : entries_named({point}, word)) out.push_back(int(1 + each.row + each.column * point.rows));
  } catch (const std::invalid_argument&) {
    throw GradientRefused(fmt::format("{}: ask for minimum, minimiser or one number of it, as {}", word,
                                      name_of(point, point.rows - 1, point.columns - 1)));
  }
  return out;
}

std::string name_of_row(const OptimisationScene& scene, int row) {
  if (row == 0) return "minimum";
  const auto point = table_of_minimiser(scene);
  return name_of(point, (row - 1) % point.rows, (row - 1) / point.rows);
}

/// What differences are compared as: numbers of a run, under these names.
GradientSubject subject_of_minimum(const OptimisationScene& scene, const MinimumTable& table) {
  GradientSubject out;
  out.system = scene.problem;
  out.observed.push_back({"minimum", "minimum"});
  for (int i = 1; i <= int(scene.instance.manifold->size()); ++i)
    out.observed.push_back({"minimiser", name_of_row(scene, i)});
  for (const ObjectiveNumber& number : table.numbers) {
    out.parameters.push_back({"parameters", number.name});
    out.sizes.push_back(number.size);
  }
  return out;
}

/// The rows, of a minimum and its minimiser.
Eigen::VectorXd values_of_rows(const GradientTable& table, double value, const optimisation::Point& x) {
  Eigen::VectorXd out(Eigen::Index(table.rows.size()));
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const int row = table.observed[i];
    out(Eigen::Index(i)) = row == 0 ? value : x(row - 1);
  }
  return out;
}

/// As ObjectiveNumbers has it. Throws NothingBeside.
std::unique_ptr<ParametricObjective> objective_beside(const ParametricObjective& objective,
                                                      const ObjectiveNumber& number, double by) {
  try {
    return ObjectiveNumbers::changed(objective, number, by);
  } catch (const std::invalid_argument& reason) {
    throw NothingBeside(fmt::format("cannot be made ({})", reason.what()));
  }
}

/// The rows of the minimum that this one becomes as a number changes. Throws NothingBeside.
Eigen::VectorXd minimised_again(const OptimisationScene& scene, const ParametricObjective& objective,
                                const MinimumTable& table, const Nudge& nudge) {
  const auto number = std::find_if(table.numbers.begin(), table.numbers.end(),
                                   [&](const ObjectiveNumber& each) { return each.name == nudge.parameter; });
  const auto changed = objective_beside(objective, *number, nudge.by);
  optimisation::TrustRegion method;
  const auto found = minimise(*scene.instance.manifold, *changed, table.found.x, method,
                              {.relative_gradient = 1e-10, .iterations = scene.stopping.iterations, .patience = 20});
  const auto at = minimum_derivatives(*scene.instance.manifold, *changed, found.x, {}, {.value_alone = true});
  if (!at.is_minimum()) throw NothingBeside(fmt::format("end at no minimum ({})", at.message));
  return values_of_rows(table.table, at.value, at.x);
}

/// The sizes of what derivatives of the value are parts of, by each number of the scene; zero where none is known.
Eigen::ArrayXd sizes_of_parts(const MinimumTable& table) {
  Eigen::ArrayXd out = Eigen::ArrayXd::Zero(Eigen::Index(table.numbers.size()));
  for (std::size_t j = 0, entry = 0; j < table.numbers.size(); ++j)
    for (std::size_t of = 0; of < table.numbers[j].entries.size(); ++of, ++entry)
      if (const double size = table.found.value_sizes(Eigen::Index(entry)); std::isfinite(size))
        out(Eigen::Index(j)) += size;
  return out;
}

/// To which the minimiser's are known.
double error_of_minimiser(const MinimumDerivatives& found) {
  double largest = 0;
  for (const auto& column : found.minimiser_by.colwise()) largest = std::fmax(largest, column.norm());
  return largest * std::pow(10, -found.digits);
}

/// The size of the least value, which may be zero, is at least that of what the numbers change of it; where derivatives
/// vanish, as of a fit without residual, that of its parts. Where curvatures are small the point moves far, and
/// rounding with it.
ValuesAreKnown known_of_minimum(const MinimumTable& table) {
  const MinimumDerivatives& found = table.found;
  const Eigen::ArrayXd parts = sizes_of_parts(table);
  const auto rows = Eigen::Index(table.table.rows.size());
  ValuesAreKnown out{.what = "minimisations"};
  out.conditions.setOnes(rows);
  out.derivatives.setConstant(rows, found.value_error);
  double& size = out.sizes["minimum"];
  for (std::size_t entry = 0, j = 0; j < table.numbers.size(); entry += table.numbers[j++].entries.size()) {
    const double change =
        found.value_is_at_rest() ? parts(Eigen::Index(j)) : std::abs(found.value_by(Eigen::Index(entry)));
    size = std::fmax(size, change * table.numbers[j].size);
  }
  if (!found.strict()) return out;
  out.rates = parts / (found.least_curvature * found.length * found.length);
  for (Eigen::Index i = 0; i < rows; ++i) {
    if (table.table.observed[std::size_t(i)] == 0) continue;
    out.conditions(i) = std::max(1.0, found.largest_curvature / found.least_curvature);
    out.derivatives(i) = error_of_minimiser(found);
  }
  return out;
}

void check_minimum(const OptimisationScene& scene, const ParametricObjective& objective, MinimumTable& table) {
  const GradientSubject subject = subject_of_minimum(scene, table);
  GradientColumns columns;
  columns.parameters.resize(table.numbers.size());
  std::iota(columns.parameters.begin(), columns.parameters.end(), 0);
  compare_with_differences(
      subject, columns, table.table,
      [&](const std::vector<Nudge>& nudges) { return minimised_again(scene, objective, table, nudges.front()); },
      known_of_minimum(table));
}

/// Whether rows are of the minimiser: those of the minimum alone need no equations to be solved.
bool asks_for_minimiser(const GradientTable& table) {
  return std::any_of(table.observed.begin(), table.observed.end(), [](int row) { return row > 0; });
}

/// Why the table has no numbers; empty where it has. A value whose derivatives all hold is told, the minimiser has
/// none.
std::string failure_of(const MinimumTable& table) {
  const MinimumDerivatives& found = table.found;
  if (found.strict()) return found.message;
  const bool is_told = !asks_for_minimiser(table.table) && table.table.derivatives.allFinite();
  if (found.status == MinimumStatus::not_strict && is_told) return "";
  return found.message;
}

}  // namespace

MinimumTable minimum_table(const OptimisationScene& scene, const ObjectiveNumbers& numbers,
                           const MinimumRequest& request) {
  constexpr Eigen::Index few = 100;
  MinimumTable out;
  out.table.system = scene.problem;
  out.manifold = scene.instance.manifold->name();
  out.method = scene.method->name();
  out.table.checked = request.check;
  for (const std::string& word : request.of.empty() ? std::vector<std::string>{"minimum"} : request.of)
    for (const int row : rows_of_minimum(scene, word)) {
      auto& observed = out.table.observed;
      if (std::find(observed.begin(), observed.end(), row) != observed.end()) continue;
      observed.push_back(row);
      out.table.rows.push_back(name_of_row(scene, row));
    }
  const auto add = [&](std::vector<ObjectiveNumber> more) {
    for (ObjectiveNumber& each : more) {
      auto& columns = out.table.columns;
      if (std::find(columns.begin(), columns.end(), each.name) != columns.end()) continue;
      columns.push_back(each.name);
      out.numbers.push_back(std::move(each));
    }
  };
  if (request.by.empty()) add(numbers.few(few, out.table.notes));
  for (const std::string& word : request.by) add(numbers.named(word));
  for (const ObjectiveNumber& each : out.numbers)
    out.found.parameters.insert(out.found.parameters.end(), each.entries.begin(), each.entries.end());
  return out;
}

void differentiate(const OptimisationScene& scene, const ParametricObjective& objective, const optimisation::Point& x,
                   MinimumTable& table) {
  GradientTable& out = table.table;
  table.found = minimum_derivatives(*scene.instance.manifold, objective, x, table.found.parameters,
                                    {.value_alone = !asks_for_minimiser(out)});
  const MinimumDerivatives& found = table.found;
  table.status = to_string(found.status);
  out.values = values_of_rows(out, found.value, found.x);
  out.derivatives.setZero(Eigen::Index(out.rows.size()), Eigen::Index(out.columns.size()));
  for (std::size_t j = 0, entry = 0; j < table.numbers.size(); ++j)
    for (std::size_t of = 0; of < table.numbers[j].entries.size(); ++of, ++entry)
      out.derivatives.col(Eigen::Index(j)) +=
          values_of_rows(out, found.value_by(Eigen::Index(entry)), found.minimiser_by.col(Eigen::Index(entry)));
  out.failure = failure_of(table);
  if (out.failure.empty() && !found.message.empty()) out.notes.push_back(found.message);
  if (out.failure.empty() && out.checked) check_minimum(scene, objective, table);
}

std::string text_of(const MinimumTable& table) {
  const MinimumDerivatives& found = table.found;
  std::string out = fmt::format("{} on the {}, {}: exact derivatives of its minimum\n\n{}\n", table.table.system,
                                table.manifold, table.method, lines_of(table.table));
  out += fmt::format("  the slope {:.1e} is left of f, curvatures are {:.3g} to {:.3g}{}\n", found.gradient,
                     found.least_curvature, found.largest_curvature,
                     found.strict() ? fmt::format(": the minimum is {:.1e} away", found.distance) : "");
  const auto& rows = table.table.observed;
  if (std::find(rows.begin(), rows.end(), 0) != rows.end())
    out += fmt::format("  derivatives of the minimum {} {:.1f} digits\n",
                       found.value_is_at_rest() ? "vanish: what they are made of has" : "have", found.value_digits);
  if (asks_for_minimiser(table.table))
    out += fmt::format("  derivatives of the minimiser have {:.1f} digits\n", found.digits);
  for (const std::string& note : table.table.notes) out += fmt::format("  note: {}\n", note);
  if (table.table.checked) out += words_of_differences(table.table, "minimisations");
  return out;
}

std::string json_of(const MinimumTable& table) {
  const MinimumDerivatives& found = table.found;
  const GradientTable& of = table.table;
  nlohmann::ordered_json out = {{"system", of.system},     {"manifold", table.manifold},
                                {"method", table.method},  {"status", of.failure.empty() ? "converged" : "failed"},
                                {"outcome", table.status}, {"message", of.failure},
                                {"of", of.rows},           {"by", of.columns}};
  if (!of.failure.empty()) return out.dump(2);
  add_derivatives(of, out);
  // As of runs (json_of in gradient_table.hpp): errors of a start do not grow here.
  out["growth"] = 1.0;
  out["digits_left"] = asks_for_minimiser(of) ? found.digits : found.value_digits;
  out["digits_of_minimum"] = found.value_digits;
  if (asks_for_minimiser(of)) out["digits_of_minimiser"] = found.digits;
  out["slope"] = found.gradient;
  if (found.strict()) out["distance"] = found.distance;
  out["least_curvature"] = found.least_curvature;
  out["largest_curvature"] = found.largest_curvature;
  out["iterations"] = found.iterations;
  add_notes_and_check(of, out);
  return out.dump(2);
}

}  // namespace lagroid::app
