#pragma once
/// Numbers that a system observes of its nodes (core/capabilities/observed_numbers.hpp) as properties that a user's own
/// system runs by naming itself: they are what the ledger watches, and their derivatives are those of the numbers.
///
///     const auto draw = [] { return laws::ObservedState<Pendulum>{draw_state()}; };
///     const laws::LawReport report = laws::observed_laws(system, draw);
///
/// Requires draw(), nodes of the system's motions. Returns a report with one entry a law, relative to the size of the
/// numbers; throws nothing.

#include <lagroid/core/capabilities/observed_numbers.hpp>
#include <lagroid/core/capabilities/parameter_numbers.hpp>
#include <lagroid/core/derivatives/extrapolated_difference.hpp>
#include <lagroid/core/noether.hpp>
#include <lagroid/core/testing/property.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace lagroid::laws {

template <DiscreteSystem Sys> struct ObservedState {
  State<typename Sys::GroupoidType> state{};
  ArrowOf<typename Sys::GroupoidType> configuration{};
};

namespace detail {

/// What is observed where the node is displaced by v, along tau, and its momentum by w.
template <class S, ObservesNumbers Sys, int N>
Vector<S, Eigen::Dynamic> observed_beside(const Sys& system, const ObservedState<Sys>& node, const Vector<S, N>& v,
                                          const Vector<S, N>& w) {
  using G = typename Sys::GroupoidType;
  const G& groupoid = system.groupoid;
  const auto displaced = groupoid.tau(groupoid.template cast_object<S>(node.state.object), v);
  State<G, S> state;
  state.object = groupoid.target(displaced);
  for (int i = 0; i < N; ++i) state.momentum(i) = w(i) + node.state.momentum(i);
  const Vector<double, G::arrow_coordinate_count()> arrow = groupoid.coordinates_of_arrow(node.configuration);
  const auto here = groupoid.template arrow_at<S>(with_entries_of<Vector<S, G::arrow_coordinate_count()>>(arrow));
  return system.observed(state, groupoid.multiply(here, displaced));
}

/// The largest component of the difference, each relative to both numbers and to one.
inline double largest_defect(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return ((a - b).array().abs() / (1 + a.array().abs() + b.array().abs())).maxCoeff();
}

}  // namespace detail

template <ObservesNumbers Sys, class Draw>
LawReport observed_laws(const Sys& given, const Draw& draw, double tolerance = 1e-9) {
  using V = Vector<double, Sys::dimension>;
  constexpr int n = Sys::dimension;
  constexpr double width = 1e-2;
  Sys system = given;
  const std::vector<ObservedName> names = Sys::observed_names();
  const auto counted = [&](const ObservedState<Sys>& node) {
    return Eigen::VectorXd(detail::observed_beside<double>(system, node, V(V::Zero()), V(V::Zero())));
  };
  const auto here = [&](const ObservedState<Sys>& node) {
    Eigen::VectorXd out = counted(node);
    if (out.size() != Eigen::Index(names.size())) throw std::logic_error("there are more numbers than names, or fewer");
    return out;
  };
  LawReport report{"observed numbers", {}};
  report.laws.push_back(check_law("there are as many as names", 0.0,
                                  [&] { return std::abs(double(counted(draw()).size()) - double(names.size())); }));
  report.laws.push_back(check_law("they are the ledger's", 1e-13, [&] {
    const ObservedState<Sys> node = draw();
    TrajectoryPoint<Sys> point;
    point.state = node.state;
    point.configuration = node.configuration;
    const Eigen::VectorXd numbers = here(node);
    double largest = 0;
    int of_nodes = 0;
    int compared = 0;
    for (const Quantity<Sys>& each : quantities_of(system)) {
      if (each.serialize || each.needs_step) continue;
      ++of_nodes;
      std::vector<double> watched(each.components.size());
      each.evaluate(point, watched.data());
      const double size =
          each.size ? each.size(point) : Eigen::VectorXd::Map(watched.data(), Eigen::Index(watched.size())).norm();
      for (std::size_t i = 0; i < watched.size(); ++i) {
        const std::string& name = watched.size() == 1 ? each.name : each.components[i];
        const auto found =
            std::find_if(names.begin(), names.end(), [&](const ObservedName& o) { return o.name == name; });
        if (found == names.end()) continue;
        ++compared;
        largest = worst({largest, std::abs(watched[i] - numbers(found - names.begin())) / (1 + size)});
      }
    }
    if (of_nodes > 0 && compared == 0) throw NotSampled("the ledger watches nothing of these names");
    return largest;
  }));
  report.laws.push_back(check_law("slopes by the node are those of differences", tolerance, [&] {
    const ObservedState<Sys> node = draw();
    here(node);  // as many as there are names
    Eigen::MatrixXd slopes(Eigen::Index(names.size()), 2 * n);
    lagroid::detail::for_directions(2 * n, [&](int first) {
      lagroid::detail::put_tangents(
          detail::observed_beside<VariedNumber>(system, node, lagroid::detail::varied_along(V(V::Zero()), -first),
                                                lagroid::detail::varied_along(V(V::Zero()), n - first)),
          first, slopes);
    });
    double largest = 0;
    for (int j = 0; j < 2 * n; ++j) {
      const auto found = extrapolated_difference(
          [&](double by) {
            V v = V::Zero(), w = V::Zero();
            (j < n ? v(j) : w(j - n)) = by;
            return std::optional<Eigen::VectorXd>(detail::observed_beside<double>(system, node, v, w));
          },
          width, 4);
      largest = worst({largest, detail::largest_defect(slopes.col(j), found->value)});
    }
    return largest;
  }));
  report.laws.push_back(check_law("slopes by parameters are those of differences", tolerance, [&] {
    const ObservedState<Sys> node = draw();
    here(node);
    double largest = 0;
    for_each_parameter_number(system, [&](const std::string&, const double& member, const auto&) {
      const double* const place = &member;
      Eigen::MatrixXd slope(Eigen::Index(names.size()), 1);
      {
        const VariedMembers varying({&place, 1}, 0);
        const Vector<VariedNumber, n> zero = lagroid::detail::varied_along(V(V::Zero()), -n);
        lagroid::detail::put_tangents(detail::observed_beside<VariedNumber>(system, node, zero, zero), 0, slope);
      }
      auto& number = const_cast<double&>(member);  // of `system`, which is no constant
      const double value = number;
      const auto found = extrapolated_difference(
          [&](double by) {
            number = value + by;
            const Eigen::VectorXd there = here(node);
            number = value;
            return std::optional<Eigen::VectorXd>(there);
          },
          width * std::max(0.1, std::abs(value)), 4);
      largest = worst({largest, detail::largest_defect(slope.col(0), found->value)});
    });
    return largest;
  }));
  return report;
}

}  // namespace lagroid::laws
