#pragma once
/// The derivative of a step on a Poisson manifold by its point and by parameters of its system, checked against
/// differences of the step: a parameter that a formula reads as a plain number has a derivative of zero, which is
/// believed of none.
///
///     const Eigen::MatrixXd all = detail::slope_by_parameters(system, {"growth"}, make, end, slope, checked);
///
/// make(system) is the step, end(step) where it leads, slope(step, members) its derivative, by those members too.
/// Parameters are compared until all of them had an effect, `checked` says which were. Errors: std::invalid_argument
/// for a name that is no parameter; WithoutDerivative, naming it, for one without a derivative.

#include <lagroid/solvers/sensitivity/varied_parameters.hpp>

#include <Eigen/Core>

#include <cmath>
#include <string>
#include <vector>

namespace lagroid::detail {

template <class Sys, class Make, class End, class Slope>
Eigen::MatrixXd slope_by_parameters(const Sys& system, const std::vector<std::string>& names, const Make& make,
                                    const End& end, const Slope& slope, std::vector<std::string>& checked) {
  const auto step = make(system);
  const ParameterPlaces places = places_of_parameters(step.system(), names);
  const Eigen::MatrixXd found = slope(step, places.members);
  if (checked == names) return found;
  bool compared = true;
  for (std::size_t j = 0; j < places.members.size(); ++j) {
    const double here = *places.members[j];
    const auto at = [&](double number) -> Eigen::VectorXd {
      Sys other = system;
      const_cast<double&>(*places_of_parameters(other, names).members[j]) = number;  // of `other`, which is a copy
      return end(make(other));
    };
    const double width = 1e-4 * (here == 0 ? 1 : std::abs(here));
    const auto difference = [&](double by) -> Eigen::VectorXd { return (at(here + by) - at(here - by)) / (2 * by); };
    const Eigen::VectorXd fine = difference(width / 2);
    require_derivative(places.names[j], found.col(found.rows() + Eigen::Index(j)), difference(width), fine,
                       at(here).norm() / width);
    compared = compared && fine.allFinite() && fine.norm() > 0;
  }
  if (compared) checked = names;
  return found;
}

}  // namespace lagroid::detail
