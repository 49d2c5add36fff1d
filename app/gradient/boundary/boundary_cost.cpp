#include "boundary_cost.hpp"

#include "../checks/differences.hpp"

#include <fmt/format.h>

namespace lagroid::app {

namespace {

std::optional<Eigen::VectorXd> as_vector(const std::optional<double>& value) {
  if (!value) return std::nullopt;
  return Eigen::VectorXd::Constant(1, *value);
}

}  // namespace

GradientTable differentiate_cost(const GradientSubject& subject, const std::vector<std::string>& of,
                                 const std::vector<std::string>& by, bool check) {
  for (const std::string& word : of)
    if (word != "cost")
      throw GradientRefused(fmt::format("{}: ask for cost, which is what a boundary value has", word));
  GradientTable out = table_of(subject, by, check);
  const GradientColumns columns = columns_of(subject, by);
  const BoundaryCost found = subject.cost(names_of(subject, columns));
  out.of_boundary_value = true;
  out.steps = found.steps;
  out.failure = found.failure;
  if (!out.failure.empty()) return out;
  out.rows = {"cost"};
  out.observed = {0};
  out.values = Eigen::VectorXd::Constant(1, found.value);
  out.derivatives.resize(1, Eigen::Index(out.columns.size()));
  for (std::size_t j = 0; j < columns.start.size(); ++j)
    out.derivatives(0, Eigen::Index(j)) = found.by_ends(columns.start[j]);
  out.derivatives.rightCols(found.by_parameters.size()) = found.by_parameters;
  set_growth(out, 1);
  if (check)
    compare_with_differences(subject, columns, out,
                             [&](const std::vector<Nudge>& nudges) { return as_vector(found.again(nudges)); },
                             {.what = "paths", .where_none = "are not found"});
  return out;
}

}  // namespace lagroid::app
