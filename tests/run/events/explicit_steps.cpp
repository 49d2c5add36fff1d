// Derivatives of explicit runs through events, by flows and by Runge-Kutta: kicks on the way, times of events and ends
// that they make, against extrapolated differences of runs from other starts and parameters, forward against backward.
#include "../../solvers/sensitivity/differences.hpp"

#include <lagroid/run/events/derivatives/motion_through_events.hpp>
#include <lagroid/solvers/sensitivity/explicit/linearised_runge_kutta.hpp>
#include <lagroid/solvers/sensitivity/explicit/linearised_splitting.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::explicit_steps_tests {
namespace {

using V = VariedNumber;
using Events = std::vector<ObservedEvent>;
constexpr long steps = 60;

/// Object and momentum.
struct Seen {
  template <class Node> VariedVector operator()(const Node& node) const {
    return joined(node.system.groupoid.coordinates_of_object(node.object), node.momentum);
  }
};

/// Its events happen amid steps of this size, where differences do not take them past nodes.
RunFrom<Kepler> orbit(double h = 0.0745) {
  RunFrom<Kepler> out{Kepler(), {{0.6, 0.1}, {0.1, 1.5}}, {}, {"strength"}};
  out.system.h = h;
  out.configuration = Pair<2>::unit(out.start.object);
  return out;
}
RunFrom<HeavyTop> top(std::vector<std::string> names) {
  RunFrom<HeavyTop> out{HeavyTop(), {{0.6, 0, 0.8}, {0.3, 0.2, 2}}, {}, std::move(names)};
  out.system.h = 0.05;
  out.configuration = out.system.groupoid.unit(out.start.object);
  return out;
}
RunFrom<SphericalPendulum> pendulum() {
  RunFrom<SphericalPendulum> out{SphericalPendulum(), {{0.6, 0, -0.8}, {0, 0.3, 0}}, {}, {}};
  out.system.h = 0.05;
  out.configuration = Pair<3>::unit(out.start.object);
  return out;
}

/// Where x p_x + y p_y falls through zero the orbit is made rounder; crossings of the x axis are recorded.
Events of_orbit() {
  ObservedEvent apogee{.name = "apogee", .when = "x*px + y*py", .function = [](const VariedVector& seen) {
                         return V(seen(1) * seen(3) + seen(2) * seen(4));
                       }};
  apogee.direction = Event::Direction::falling;
  apogee.kick = [](const VariedVector& seen) {
    VariedVector by(2);
    by << seen(3) * 0.1 + seen(2) * 0.02, seen(4) * 0.1;
    return by;
  };
  ObservedEvent axis{.name = "axis", .when = "y - t/100", .function = [](const VariedVector& seen) {
                       return V(seen(2) - seen(0) * 0.01);
                     }};
  return {apogee, axis};
}
/// The third number of an object passes zero, or what is given, and the first of the momentum is changed.
Events of_third(double level, int momenta) {
  ObservedEvent pass{
      .name = "pass", .when = "z", .function = [level](const VariedVector& seen) { return V(seen(3) - level); }};
  pass.kick = [momenta](const VariedVector& seen) {
    VariedVector by = VariedVector::Constant(momenta, V(0));
    by(0) = seen(4) * 0.2 + seen(2) * 0.1;
    by(1) = seen(1) * 0.15;
    return by;
  };
  return {pass};
}

auto by_flows(const Composition& composition, const Events& events) {
  return [&composition, events]<class Sys>(const RunFrom<Sys>& from) {
    return std::make_unique<MotionThroughEvents>(
        std::make_unique<LinearisedSplitting<Sys>>(from.system, from.start, from.configuration, composition, from.names,
                                                   Seen()),
        events);
  };
}
auto by_runge_kutta(const Events& events) {
  return [events]<class Sys>(const RunFrom<Sys>& from) {
    return std::make_unique<MotionThroughEvents>(
        std::make_unique<LinearisedRungeKutta<Sys>>(from.system, from.start, from.configuration, from.names, Seen()),
        events);
  };
}

/// How often something happens in a run.
template <class Sys, class Make> std::size_t happened(const RunFrom<Sys>& from, const Make& make) {
  const auto motion = make(from);
  const EventSensitivities run = motion->run(steps, Eigen::MatrixXd(motion->states() + motion->parameters(), 0));
  EXPECT_TRUE(run.converged()) << run.message;
  return run.happened.size();
}

/// Times and what is seen at each event and at the end, by all directions of the start and the parameters.
template <class Sys, class Make> void expect_exact_events(const RunFrom<Sys>& from, const Make& make) {
  const auto all_of = [](const EventSensitivities& run) {
    std::vector<double> out{run.time};
    for (const auto& each : run.happened) {
      out.push_back(each.time);
      out.insert(out.end(), each.observed.begin(), each.observed.end());
    }
    out.insert(out.end(), run.observed.begin(), run.observed.end());
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(out.data(), Eigen::Index(out.size())));
  };
  const auto motion = make(from);
  const EventSensitivities run = motion->run(steps, directions_of_start(*motion, 2 * Sys::dimension));
  ASSERT_TRUE(run.converged()) << run.message;
  const Eigen::VectorXd here = all_of(run);
  const auto columns = run.observed_by_start.cols() + run.observed_by_parameters.cols();
  Eigen::MatrixXd by = Eigen::MatrixXd::Zero(here.size(), columns);
  Eigen::Index row = 0;
  const auto put = [&](const Eigen::MatrixXd& by_start, const Eigen::MatrixXd& by_parameters) {
    by.block(row, 0, by_start.rows(), by_start.cols()) = by_start;
    by.block(row, by_start.cols(), by_start.rows(), by_parameters.cols()) = by_parameters;
    row += by_start.rows();
  };
  if (run.is_stopped) {
    put(run.happened.back().by_start, run.happened.back().by_parameters);
  } else {
    ++row;
  }
  for (const auto& each : run.happened) {
    put(each.by_start, each.by_parameters);
    put(each.observed_by_start, each.observed_by_parameters);
  }
  put(run.observed_by_start, run.observed_by_parameters);
  for (int which = 0; which < int(columns); ++which) {
    const auto beside = [&](double change) -> Eigen::VectorXd {
      const auto other = make(from.moved(which, change));
      return all_of(other->run(steps, Eigen::MatrixXd(other->states() + other->parameters(), 0)));
    };
    const Eigen::VectorXd difference = laws::detail::extrapolated_difference(beside, 4e-4);
    EXPECT_LT((by.col(which) - difference).norm(), 1e-8 * std::max(1.0, difference.norm())) << which;
  }
}

TEST(ExplicitStepsThroughEvents, AreWhatDifferencesTendTo) {
  const auto orbits = {std::pair(compositions::single, 0.08), std::pair(splittings::srkn6, 0.0745)};
  for (const auto& [composition, h] : orbits) {
    EXPECT_GT(happened(orbit(h), by_flows(composition, of_orbit())), 1u);
    expect_exact_derivatives(orbit(h), by_flows(composition, of_orbit()), steps);
    expect_exact_events(orbit(h), by_flows(composition, of_orbit()));
  }
  EXPECT_GT(happened(top({}), by_flows(compositions::suzuki, of_third(0.7, 3))), 0u);
  expect_exact_derivatives(top({}), by_flows(compositions::suzuki, of_third(0.7, 3)), steps);
  expect_exact_events(top({}), by_flows(compositions::suzuki, of_third(0.7, 3)));
  // A kick along the rod is one that the flow on the sphere does not take.
  EXPECT_GT(happened(pendulum(), by_flows(splittings::srkn6, of_third(-0.85, 3))), 0u);
  expect_exact_derivatives(pendulum(), by_flows(splittings::srkn6, of_third(-0.85, 3)), steps);
}

TEST(ExplicitStepsThroughEvents, OfRungeKuttaDriftOffTheGroupoidAndAreExact) {
  EXPECT_GT(happened(orbit(), by_runge_kutta(of_orbit())), 1u);
  expect_exact_derivatives(orbit(), by_runge_kutta(of_orbit()), steps);
  expect_exact_events(orbit(), by_runge_kutta(of_orbit()));
  const RunFrom<HeavyTop> from = top({"inertia", "weight"});
  EXPECT_GT(happened(from, by_runge_kutta(of_third(0.7, 3))), 0u);
  expect_exact_derivatives(from, by_runge_kutta(of_third(0.7, 3)), steps);
  expect_exact_events(from, by_runge_kutta(of_third(0.7, 3)));
}

TEST(ExplicitStepsThroughEvents, EndWhereAnEventSaysSo) {
  Events events = of_orbit();
  events[1].then = Event::Then::stop;
  const auto motion = by_flows(splittings::srkn6, events)(orbit());
  const EventSensitivities run = motion->run(steps, directions_of_start(*motion, 4));
  EXPECT_TRUE(run.is_stopped);
  expect_exact_events(orbit(), by_flows(splittings::srkn6, events));
  expect_exact_events(orbit(), by_runge_kutta(events));
}

TEST(ExplicitStepsThroughEvents, HeldAtTheirTimesMissTheDifferences) {
  // The same kicks, at the times at which they happen from the first start.
  const auto first = by_flows(splittings::srkn6, of_orbit())(orbit());
  const EventSensitivities run = first->run(steps, Eigen::MatrixXd(first->states() + first->parameters(), 0));
  double time = 0;
  for (const auto& each : run.happened)
    if (each.event == 0 && time == 0) time = each.time;
  ASSERT_GT(time, 0);
  Events held{of_orbit()[0]};
  held[0].direction = Event::Direction::both;
  held[0].function = [time](const VariedVector& seen) { return V(seen(0) - time); };
  EXPECT_GT(missed_differences(orbit(), by_flows(splittings::srkn6, held), by_flows(splittings::srkn6, {of_orbit()[0]}),
                               steps),
            1e-3);
}

/// A bob whose flows take times as plain numbers.
struct PlainBob : System<PlainBob, Pair<1>> {
  double h = 0.1;
  static constexpr int parts = 2;
  template <int Part, class S> FlowOf<Pair<1>, S> flow(double t, const Vector<S, 1>& q, const Vector<S, 1>& p) const {
    if constexpr (Part == 0) return {{q, q}, q * -t};
    if constexpr (Part == 1) return {{q, q + p * t}, p * 0.0};
  }
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const {
    const Vector<S, 1> v = g.target - g.source;
    return v.squaredNorm() / (2 * h) - g.source.squaredNorm() * (0.5 * h);
  }
};

TEST(ExplicitStepsThroughEvents, OfFlowsThatTakePlainTimesHaveNone) {
  const RunFrom<PlainBob> from{
      {}, {Vector<double, 1>(1.0), Vector<double, 1>(0.0)}, Pair<1>::unit(Vector<double, 1>(1.0)), {}};
  ObservedEvent low{.name = "low", .when = "q", .function = [](const VariedVector& seen) { return V(seen(1)); }};
  const auto make = by_flows(compositions::single, {low});
  const auto motion = make(from);
  EXPECT_THROW(motion->run(steps, Eigen::MatrixXd::Identity(2, 2)), WithoutDerivative);
}

}  // namespace
}  // namespace lagroid::explicit_steps_tests
