#pragma once
/// The parameters of a system with respect to which derivatives are taken: by their names, number by number.
///
///     const std::vector<std::string> names = {"mass", "inertia"};  // of `parameters()`; a vector is all its numbers
///     const ParameterPlaces places = places_of_parameters(system, names);
///     const double* first = places.members[0];  // a member of this very system
///
/// Errors: std::invalid_argument for a name that is no parameter of the system or a choice of words, one line;
/// WithoutDerivative where a derivative was found to be none.

#include <lagroid/core/capabilities/parameter_numbers.hpp>

#include <Eigen/Core>

#include <stdexcept>
#include <string>
#include <vector>

namespace lagroid {

/// A parameter that a system reads as a plain number somewhere, so that its derivatives would be wrong.
class WithoutDerivative : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

struct ParameterPlaces {
  std::vector<std::string> names;  ///< mass, inertia.0, inertia.1, ...
  std::vector<const double*> members;
};

namespace detail {

/// Takes from `all` those of a name: the name itself, or with a dot and a number; throws where there is none.
ParameterPlaces chosen_places(const ParameterPlaces& all, const std::vector<std::string>& names,
                              const std::vector<std::string>& choices);
/// Throws WithoutDerivative unless derivatives by a member are near its differences: `coarse` and `fine`, of twice the
/// width of the fine ones.
void require_derivative(const std::string& name, const Eigen::VectorXd& derivative, const Eigen::VectorXd& coarse,
                        const Eigen::VectorXd& fine, double rounding);

}  // namespace detail

/// All parameters that are numbers, or vectors of them.
template <class Sys> ParameterPlaces all_parameters(const Sys& system) {
  ParameterPlaces out;
  for_each_parameter_number(system, [&](const std::string& name, const double& number, const auto&) {
    out.names.push_back(name);
    out.members.push_back(&number);
  });
  return out;
}

template <class Sys> ParameterPlaces places_of_parameters(const Sys& system, const std::vector<std::string>& names) {
  std::vector<std::string> choices;
  for_each_parameter<Sys>([&]<class Declared>(const Declared& p) {
    if constexpr (requires { p.words; }) choices.emplace_back(p.name);
  });
  return detail::chosen_places(all_parameters(system), names, choices);
}

}  // namespace lagroid
