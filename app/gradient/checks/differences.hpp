#pragma once
/// Derivatives of a table beside central differences of runs, extrapolated (Richardson): what they agree to, what they
/// contradict and what they cannot tell.
///
///     compare_with_differences(subject, columns, table, values, {.growth = 12});
///
/// Widths are small parts of a number's size, and narrower where that changes rows by more than theirs, as angles far
/// along a run: entries are compared at one after another until they agree. By the last
/// extrapolation, by rounding and by the tolerance of inner steps, which grow along the run, a difference is known to
/// so much; an entry that is off by more wherever differences are known at all is contradicted.
///
/// Errors: GradientRefused where runs beside this one cannot be compared.

#include "../gradient_table.hpp"
#include "run_growth.hpp"

#include <functional>
#include <optional>

namespace lagroid::app {

/// How exactly values of runs beside each other are known, over their sizes.
struct ValuesAreKnown {
  SizesOfUnits sizes = {};  ///< of the run; of others the table's own
  double growth = 1;        ///< of their rounding, and of errors that a tolerance lets be
  double tolerance = 0;     ///< of inner steps: to this, grown, runs beside each other are values of one function
};

/// Adds differences to the table; `values` has its rows of runs from starts that differ, none where these end early.
void compare_with_differences(const GradientSubject& subject, const GradientColumns& columns, GradientTable& table,
                              const std::function<std::optional<Eigen::VectorXd>(const std::vector<Nudge>&)>& values,
                              const ValuesAreKnown& known);

}  // namespace lagroid::app
