#pragma once
/// Derivatives of a table beside central differences of runs, extrapolated (Richardson): what they agree to, what they
/// contradict and what they cannot tell.
///
///     compare_with_differences(subject, columns, table, values, {.growth = 12});
///
/// Widths are small parts of a number's size, and narrower where that changes rows by more than theirs, as angles far
/// along a run, or what rows do not show, as the point where a minimum is taken: entries are compared at one after
/// another until they agree. By the last extrapolation, by rounding and by the tolerance of inner steps, which grow
/// along the run, a difference is known to so much, and by their own rounding derivatives are; an entry that is off by
/// more wherever differences are known at all is contradicted.
///
/// Errors: GradientRefused where nothing beside this one can be compared.

#include "../gradient_table.hpp"
#include "run_growth.hpp"

#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

namespace lagroid::app {

/// How exactly values of runs beside each other are known, over their sizes, and derivatives.
struct ValuesAreKnown {
  std::string what = "runs";             ///< what is beside each other
  std::string where_none = "end early";  ///< what is so of those that have no values
  SizesOfUnits sizes = {};               ///< of the run; of others the table's own
  double growth = 1;                     ///< of their rounding, and of errors that a tolerance lets be
  double tolerance = 0;  ///< of inner steps: to this, grown, runs beside each other are values of one function
  Eigen::ArrayXd conditions = {};   ///< by which rounding of each row grows beside; empty: not
  Eigen::ArrayXd derivatives = {};  ///< to which those of each row are known; empty: to more than differences are
  Eigen::ArrayXd rates = {};  ///< of each column, at which it changes what rows do not show, over its size, or takes an
                              ///< event to a node, where derivatives have a kink; empty: none
};

/// The same, of one that has none for a reason of its own.
class NothingBeside : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Adds differences to the table; `values` has its rows of runs from starts that differ, none where there are
/// none.
void compare_with_differences(const GradientSubject& subject, const GradientColumns& columns, GradientTable& table,
                              const std::function<std::optional<Eigen::VectorXd>(const std::vector<Nudge>&)>& values,
                              const ValuesAreKnown& known);

}  // namespace lagroid::app
