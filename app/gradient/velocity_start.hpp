#pragma once
/// Starts that scenes give by velocities (core/derivatives/velocity_start.hpp), or by momenta.
///
/// States of a run are places and momenta; where a scene gives velocities these are what is kept as parameters change.
///
///     auto given = given_beside_place(system, start);
///     given(0) += 0.1;
///     start.momentum = momentum_of_given(system, start.object, given);
///
/// Requires a start that keeps the constraints. Nothing throws but std::invalid_argument for a parameter that is none.

#include <lagroid/core/derivatives/velocity_start.hpp>
#include <lagroid/solvers/sensitivity/varied_parameters.hpp>

#include <string>
#include <vector>

namespace lagroid::app {

template <DiscreteSystem Sys>
auto given_beside_place(const Sys& system, const State<typename Sys::GroupoidType>& start) {
  if constexpr (StartsByVelocity<Sys>) {
    return VelocitiesOf<Sys>(system.velocities(start));
  } else {
    return start.momentum;
  }
}

template <DiscreteSystem Sys, class Given>
AlgebroidVector<typename Sys::GroupoidType> momentum_of_given(const Sys& system,
                                                              const ObjectOf<typename Sys::GroupoidType>& object,
                                                              const Given& given) {
  if constexpr (StartsByVelocity<Sys>) {
    return system.momentum_of(object, given);
  } else {
    return given;
  }
}

/// Of (displacement, momentum) at the start by the displacement, the velocities and these parameters.
template <StartsByVelocity Sys>
Eigen::MatrixXd slope_of_start(const Sys& system, const State<typename Sys::GroupoidType>& start,
                               const std::vector<std::string>& parameters) {
  using G = typename Sys::GroupoidType;
  constexpr int n = G::dimension, velocities = int(Sys::velocity_names.size());
  const ParameterPlaces places = places_of_parameters(system, parameters);
  const int count = n + velocities + int(places.members.size());
  const G& groupoid = system.groupoid;
  const VelocitiesOf<Sys> given = system.velocities(start);
  const Vector<double, n> zero = Vector<double, n>::Zero();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(2 * n, count);
  out.topLeftCorner(n, n).setIdentity();
  lagroid::detail::for_directions(count, [&](int first) {
    const VariedMembers varying(places.members, n + velocities - first);
    const ObjectOf<G, VariedNumber> object = groupoid.target(groupoid.tau(
        groupoid.template cast_object<VariedNumber>(start.object), lagroid::detail::varied_along(zero, -first)));
    lagroid::detail::put_tangents(system.momentum_of(object, lagroid::detail::varied_along(given, n - first)), first,
                                  out.bottomRows(n));
  });
  return out;
}

}  // namespace lagroid::app
