#pragma once
/// The derivatives of a minimum as a table: which rows and columns, how they are compared with minimisations beside,
/// and how they are printed.
///
///     MinimumTable table = minimum_table(scene, numbers, request);
///     differentiate(scene, objective, found.x, table);
///     print(text_of(table));
///
/// Errors: GradientRefused, one line, for what has no such name; how it ended is in `failure`.

#include "../../optimise/optimisation_scene.hpp"
#include "../gradient_table.hpp"
#include "minimum_gradient.hpp"
#include "objective_numbers.hpp"

#include <lagroid/solvers/optimisation/sensitivity/minimum_derivatives.hpp>

#include <string>
#include <vector>

namespace lagroid::app {

struct MinimumTable {
  GradientTable table;  ///< `observed`: 0 the minimum, from 1 the numbers of the minimiser
  std::string manifold;
  std::string method;
  std::string status;  ///< of the minimisation, or of the minimum
  std::vector<ObjectiveNumber> numbers;
  optimisation::MinimumDerivatives found;
};

/// With its rows and columns, and without numbers. Throws GradientRefused.
MinimumTable minimum_table(const OptimisationScene& scene, const ObjectiveNumbers& numbers,
                           const MinimumRequest& request);
/// At the minimum near x.
void differentiate(const OptimisationScene& scene, const optimisation::ParametricObjective& objective,
                   const optimisation::Point& x, MinimumTable& table);

std::string text_of(const MinimumTable& table);
std::string json_of(const MinimumTable& table);

}  // namespace lagroid::app
