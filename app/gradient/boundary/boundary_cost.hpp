#pragma once
/// The derivatives of `lagroid gradient` of a boundary value: of the cost of its path, by both ends and the parameters.
///
///     const GradientTable table = differentiate_cost(subject, {"cost"}, {"boundary.end"}, true);
///
/// Requires a subject with a `cost`. Columns are boundary.start.NAME, boundary.end.NAME and parameters.NAME. Errors:
/// GradientRefused, one line, for another row than `cost` or no such name.

#include "../gradient_table.hpp"

#include <string>
#include <vector>

namespace lagroid::app {

GradientTable differentiate_cost(const GradientSubject& subject, const std::vector<std::string>& of,
                                 const std::vector<std::string>& by, bool check);

}  // namespace lagroid::app
