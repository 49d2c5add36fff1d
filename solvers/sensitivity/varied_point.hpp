#pragma once
/// Functions of a point of a trajectory with their derivatives, and the check that a system's derivatives by a member
/// are what differences tend to.
///
/// Nodes and points within steps are observed alike; a member that a formula reads as a plain number is found out
/// before its derivative, which would be zero, is believed.
///
///     const NodeValues there = detail::values_at(system, places, point, 0, [](int, const auto& q, const auto&, const
///     auto&) {
///       return VariedVector(q);
///     });
///
/// Requires places of members of this very system. Errors: WithoutDerivative, naming the member.

#include <lagroid/core/quantity.hpp>
#include <lagroid/solvers/sensitivity/linearised_motion.hpp>
#include <lagroid/solvers/sensitivity/linearised_step.hpp>
#include <lagroid/solvers/sensitivity/varied_momentum.hpp>
#include <lagroid/solvers/sensitivity/varied_parameters.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

using VariedVector = Eigen::Matrix<VariedNumber, Eigen::Dynamic, 1>;

/// Which derivatives are compared with differences: each once, and one that is held not before it varies.
class Comparisons {
 public:
  explicit Comparisons(std::size_t count) : states_(count, State::due) {}
  /// It varies along no direction, so that a formula may read it as a plain number.
  void hold(std::size_t member) { states_[member] = State::held; }
  /// If it was held, it varies from now on.
  void vary(std::size_t member) {
    if (states_[member] == State::held) states_[member] = State::due;
  }
  /// Visits those that are due, which are done then.
  template <class Visit> void take(const Visit& visit) {
    for (std::size_t j = 0; j < states_.size(); ++j)
      if (states_[j] == State::due) {
        states_[j] = State::done;
        visit(j);
      }
  }

 private:
  enum class State : char { due, done, held };
  std::vector<State> states_;
};

namespace detail {

/// f(object, momentum, configuration), the momentum the one that is reported, with its tangents by (v, mu, theta) from
/// direction `first` on; beyond all of them, its values alone.
template <DiscreteSystem Sys, class F>
VariedVector varied_at(const Sys& system, const ParameterPlaces& places, const TrajectoryPoint<Sys>& point, int first,
                       const F& f) {
  using G = typename Sys::GroupoidType;
  using V = VariedNumber;
  constexpr int n = Sys::dimension;
  const G& groupoid = system.groupoid;
  const Vector<double, n> zero = Vector<double, n>::Zero();
  const VariedMembers varying(places.members, 2 * n - first);
  const auto moved = groupoid.tau(groupoid.template cast_object<V>(point.state.object), varied_along(zero, -first));
  const Vector<V, n> momentum = varied_along(point.state.momentum, n - first);
  const ObjectOf<G, V> object = groupoid.target(moved);
  return f(object, varied_tangent_momentum(system, object, momentum),
           groupoid.compose(groupoid.template cast<V>(point.configuration), moved));
}

/// f(first, object, momentum, configuration), the momentum the one that is reported, with its derivatives by (v, mu,
/// theta) and by `beside` more directions, which f varies itself: a row for each number. `first` is the direction of
/// the first tangent.
template <DiscreteSystem Sys, class F>
NodeValues values_at(const Sys& system, const ParameterPlaces& places, const TrajectoryPoint<Sys>& point, int beside,
                     const F& f) {
  NodeValues out;
  const int count = 2 * Sys::dimension + int(places.members.size()) + beside;
  for_directions(count, [&](int first) {
    const VariedVector here = varied_at(system, places, point, first,
                                        [&](const auto& object, const auto& momentum, const auto& configuration) {
                                          return f(first, object, momentum, configuration);
                                        });
    if (out.values.size() == 0) {
      out.values.resize(here.size());
      out.derivatives.resize(here.size(), count);
    }
    for (Eigen::Index i = 0; i < here.size(); ++i) {
      out.values(i) = here(i).value;
      for (int k = first; k < std::min(count, first + varied_at_once); ++k)
        out.derivatives(i, k) = here(i).tangent(k - first);
    }
  });
  return out;
}

/// The derivatives of the step equations by a member of the system, in this column of the linearised step, beside
/// differences of what a step computes.
template <DiscreteSystem Sys>
void compare_with_differences(const Sys& system, double& member, const std::string& name, const Step<Sys>& step,
                              const LinearStep& linear, Eigen::Index column) {
  constexpr int n = Sys::dimension;
  constexpr int m = Sys::constraints;
  const auto at = [&](double value) {
    const double kept = std::exchange(member, value);
    const GradientsOf<Sys> d = gradients(system, step.arrow, step.multipliers);
    member = kept;
    Eigen::VectorXd all(2 * n + m);
    all << -d.source_gradient, d.constraint, d.source_gradient + d.target_gradient;
    return all;
  };
  const double here = member;
  const double width = 1e-4 * (here == 0 ? 1 : std::abs(here));
  const auto difference = [&](double by) -> Eigen::VectorXd { return (at(here + by) - at(here - by)) / (2 * by); };
  Eigen::VectorXd derivative(2 * n + m);
  derivative << linear.equations_by_start.col(column), linear.end_by_start.col(column).tail(n);
  require_derivative(name, derivative, difference(width), difference(width / 2), at(here).norm() / width);
}

/// Of a node, in the units of what it consists of.
template <DiscreteSystem Sys> double size_of(const Sys& system, const TrajectoryPoint<Sys>& point) {
  return point.state.momentum.norm() + system.groupoid.coordinates_of_arrow(point.configuration).norm();
}

/// The derivatives of where a step in closed form ends by each parameter, a column each, beside differences of end(),
/// which computes it from members as they are: of a system that is no constant. `size` is that of what rounding is of.
template <class End>
void compare_with_differences(const ParameterPlaces& places, const Eigen::MatrixXd& derivatives, double size,
                              const End& end) {
  for (std::size_t j = 0; j < places.members.size(); ++j) {
    double& member = const_cast<double&>(*places.members[j]);
    const double here = member;
    const auto at = [&](double value) -> Eigen::VectorXd {
      member = value;
      const Eigen::VectorXd there = end();
      member = here;
      return there;
    };
    const double width = 1e-4 * (here == 0 ? 1 : std::abs(here));
    const auto difference = [&](double by) -> Eigen::VectorXd { return (at(here + by) - at(here - by)) / (2 * by); };
    require_derivative(places.names[j], derivatives.col(Eigen::Index(j)), difference(width), difference(width / 2),
                       size / width);
  }
}

/// Those by one of the parameters, or by each, whose columns are behind those of the start.
template <DiscreteSystem Sys>
void compare_with_differences(const Sys& system, const ParameterPlaces& places, std::size_t parameter,
                              const Step<Sys>& step, const LinearStep& linear) {
  compare_with_differences(system, const_cast<double&>(*places.members[parameter]),  // of the system, no constant
                           places.names[parameter], step, linear, 2 * Sys::dimension + Eigen::Index(parameter));
}
template <DiscreteSystem Sys>
void compare_with_differences(const Sys& system, const ParameterPlaces& places, const Step<Sys>& step,
                              const LinearStep& linear) {
  for (std::size_t j = 0; j < places.members.size(); ++j) compare_with_differences(system, places, j, step, linear);
}

}  // namespace detail

}  // namespace lagroid
