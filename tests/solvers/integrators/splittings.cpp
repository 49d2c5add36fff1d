// Explicit splittings: their flows, the orders of their compositions, and what they keep.
#include "../../support/allocation_counter.hpp"
#include "../../support/broken.hpp"

#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/solvers/testing/splitting_laws.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/damped_pendulum.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rotations/driven_body.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>
#include <lagroid/systems/rotations/moser_veselov.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <lagroid/solvers/testing/order_laws.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

using namespace lagroid;

namespace {

static_assert(SplitSystem<Pendulum> && SplitSystem<Kepler> && SplitSystem<RigidBody> && SplitSystem<HeavyTop>);
static_assert(SplitSystem<SphericalPendulum> && NystromSystem<SphericalPendulum> && !NystromSystem<RigidBody>);
static_assert(!SplitSystem<DampedPendulum> && !SplitSystem<DrivenBody>);  // flows that know nothing of the forces
static_assert(!SplitSystem<MoserVeselov>);

// ---- coefficients

double power_sum(const Composition& composition, int k) {
  double sum = 0;
  for (const double gamma : composition.coefficients) sum += std::pow(gamma, k);
  return sum;
}
double largest_defect_of_the_conditions(const Composition& composition) {
  double defect = std::abs(power_sum(composition, 1) - 1);
  for (int k = 3; k < composition.order; k += 2) defect = std::max(defect, std::abs(power_sum(composition, k)));
  return defect;
}
bool is_symmetric(const Composition& composition) {
  const auto& gamma = composition.coefficients;
  return std::equal(gamma.begin(), gamma.end(), gamma.rbegin());
}

TEST(Compositions, MeetTheConditionsOfTheirOrder) {
  for (const auto& composition : compositions::all) {
    EXPECT_TRUE(is_symmetric(composition)) << composition.name;
    EXPECT_LT(largest_defect_of_the_conditions(composition), 1e-14) << composition.name;
    // No condition of the next order holds by chance.
    EXPECT_GT(std::abs(power_sum(composition, composition.order + 1)), 1e-15) << composition.name;
  }
}

TEST(Compositions, OfMistypedCoefficientsDoNot) {
  for (const auto& composition : compositions::all) {
    if (composition.stages() == 1) continue;
    std::vector<double> wrong(composition.coefficients.begin(), composition.coefficients.end());
    std::swap(wrong[0], wrong[wrong.size() / 2]);
    EXPECT_FALSE(is_symmetric({"mistyped", composition.order, wrong, ""})) << composition.name;
    wrong.assign(composition.coefficients.begin(), composition.coefficients.end());
    wrong.front() += 1e-8;
    wrong.back() += 1e-8;
    EXPECT_GT(largest_defect_of_the_conditions({"mistyped", composition.order, wrong, ""}), 1e-9) << composition.name;
  }
}

// ---- flows

HeavyTop asymmetric_top() {
  HeavyTop top;
  top.inertia << 1.1, 0.8, 0.5;
  top.weight << 0.3, -0.2, 0.9;
  return top;
}
State<Pair<1>> draw_pendulum() { return {laws::draw_vector<1>(3.0), laws::draw_vector<1>(3.0)}; }
State<Pair<2>> draw_orbit() {
  const Vector<double, 4> wobble = 0.2 * laws::draw_vector<4>(1.0);
  return {{1 + wobble(0), wobble(1)}, {wobble(2), 1 + wobble(3)}};
}
State<SO3> draw_body() {
  State<SO3> s;
  s.momentum = laws::draw_vector<3>(3.0);
  return s;
}
State<HeavyTop::GroupoidType> draw_top() {
  const Vector<double, 3> v = laws::draw_vector<3>(1.0) + Vector<double, 3>(0.01, -0.02, 0.03);
  return {v.normalized(), laws::draw_vector<3>(1.5)};
}

TEST(Flows, AreThoseOfTheParts) {
  const auto pendulum = laws::splitting_laws(Pendulum{}, draw_pendulum);
  EXPECT_TRUE(pendulum.holds()) << pendulum;
  const auto orbit = laws::splitting_laws(Kepler{}, draw_orbit, 0.3);
  EXPECT_TRUE(orbit.holds()) << orbit;
  const auto top = laws::splitting_laws(asymmetric_top(), draw_top);
  EXPECT_TRUE(top.holds()) << top;
}

TEST(Flows, OfBodiesOfEveryShape) {
  // Every order of the moments, and symmetric ones.
  for (const Vector<double, 3>& inertia :
       {Vector<double, 3>(1, 2, 2.5), Vector<double, 3>(2, 1, 2.5), Vector<double, 3>(2.5, 2, 1),
        Vector<double, 3>(1, 2.5, 2), Vector<double, 3>(1, 1, 0.5), Vector<double, 3>(1, 1, 1)}) {
    RigidBody body;
    body.inertia = inertia;
    const auto report = laws::splitting_laws(body, draw_body);
    EXPECT_TRUE(report.holds()) << inertia.transpose() << '\n' << report;
  }
}

/// A kick the wrong way; a drift that loses a thousandth of the momentum; a rotation by its linear part.
struct KickedBack : Kepler {
  template <int Part, class S> FlowOf<Pair<2>, S> flow(double t, const Vector<S, 2>& q, const Vector<S, 2>& p) const {
    return Kepler::flow<Part, S>(Part == 0 ? -t : t, q, p);
  }
};
struct Rubbed : Kepler {
  template <int Part, class S> FlowOf<Pair<2>, S> flow(double t, const Vector<S, 2>& q, const Vector<S, 2>& p) const {
    auto out = Kepler::flow<Part, S>(t, q, p);
    if (Part == 1) out.momentum_change = p * S(-1e-3 * t);
    return out;
  }
};
template <class Derived> struct Altered : System<Derived, SO3> {
  double h = 0.01;
  template <class S> S lagrangian(const Matrix<S, 3, 3>& g) const {
    RigidBody body;
    body.h = h;
    return body.lagrangian(g);
  }
  static constexpr int parts = RigidBody::parts;
};
struct TurnedByEuler : Altered<TurnedByEuler> {
  template <int Part, class S> FlowOf<SO3, S> flow(double t, const Vector<S, 0>& q, const Vector<S, 3>& mu) const {
    auto out = RigidBody{}.flow<Part, S>(t, q, mu);
    if (Part == 0) out.momentum_change = mu.cross(SO3::log(out.arrow));
    return out;
  }
};
struct TurnedBack : Altered<TurnedBack> {
  template <int Part, class S> FlowOf<SO3, S> flow(double t, const Vector<S, 0>& q, const Vector<S, 3>& mu) const {
    auto out = RigidBody{}.flow<Part, S>(t, q, mu);
    out.arrow.transposeInPlace();
    return out;
  }
};

TEST(BrokenFlows, FailTheLawsTheyBreak) {
  const auto kicked = laws::splitting_laws(KickedBack{}, draw_orbit, 0.3);
  EXPECT_TRUE(laws::seen_broken(kicked.law("the parts add up to the system"))) << kicked;
  EXPECT_TRUE(kicked.law("part 0 is Poisson").holds()) << kicked;
  const auto rubbed = laws::splitting_laws(Rubbed{}, draw_orbit, 0.3);
  EXPECT_TRUE(laws::seen_broken(rubbed.law("part 1 is Poisson"))) << rubbed;
  const auto euler = laws::splitting_laws(TurnedByEuler{}, draw_body);
  EXPECT_TRUE(laws::seen_broken(euler.law("part 0 is a flow"))) << euler;
  EXPECT_TRUE(laws::seen_broken(euler.law("part 0 is Poisson"))) << euler;
  const auto back = laws::splitting_laws(TurnedBack{}, draw_body);
  EXPECT_TRUE(laws::seen_broken(back.law("the parts add up to the system"))) << back;
}

// ---- orders

template <class Sys>
SplittingIntegrator<Sys> make(const Sys& system, const State<typename Sys::GroupoidType>& start,
                              const Composition& composition) {
  return SplittingIntegrator<Sys>(system, start, system.groupoid.unit(start.object), composition);
}

/// A problem: where it starts, how far it goes, in how few steps, and how far the end of a run is from the exact one.
template <class Sys> struct Problem {
  Sys system;
  State<typename Sys::GroupoidType> start;
  double horizon;
  int steps;
  std::function<double(const TrajectoryPoint<Sys>&)> error;
};

Problem<Pendulum> swing() {
  const Pendulum system;
  const State<Pair<1>> start{Vector<double, 1>(1.2), Vector<double, 1>(0.3)};
  const auto exact = system.reference(start, 10);
  return {system, start, 10, 20, [exact](const auto& end) {
            return (end.state.object - exact.object).norm() + (end.state.momentum - exact.momentum).norm();
          }};
}
/// Once around an ellipse of eccentricity 0.3.
Problem<Kepler> orbit() {
  const Kepler system;
  const State<Pair<2>> start{{0.7, 0}, {0, std::sqrt(1.3 / 0.7)}};
  return {system, start, 2 * std::numbers::pi, 30, [start](const auto& end) {
            return (end.state.object - start.object).norm() + (end.state.momentum - start.momentum).norm();
          }};
}
Problem<RigidBody> body() {
  const RigidBody system;
  State<SO3> start;
  start.momentum << 0.3, 1.5, 0.4;
  Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  const auto exact = system.reference(start, attitude, 10);
  return {system, start, 10, 10, [exact, attitude](const auto& end) {
            return (end.state.momentum - exact.momentum).norm() + (end.configuration - attitude).norm();
          }};
}
const State<HeavyTop::GroupoidType> leaning{Vector<double, 3>(0.48, 0.6, 0.64), Vector<double, 3>(0.3, -0.2, 1.5)};
Problem<HeavyTop> top() {
  const HeavyTop system = asymmetric_top();
  Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  const auto exact = system.reference(leaning, attitude, 5);
  return {system, leaning, 5, 20, [exact, attitude](const auto& end) {
            return (end.state.object - exact.object).norm() + (end.state.momentum - exact.momentum).norm() +
                   (end.configuration.element - attitude).norm();
          }};
}

/// The error at the end of the run, in steps of horizon / steps.
template <class Sys> double error_of(const Problem<Sys>& problem, const Composition& composition, int steps) {
  Sys system = problem.system;
  system.h = problem.horizon / steps;
  auto integrator = make(system, problem.start, composition);
  for (int k = 0; k < steps; ++k) EXPECT_TRUE(integrator.advance().converged());
  return problem.error(integrator.point());
}

template <class Sys> double order_of(const Problem<Sys>& problem, const Composition& composition) {
  return laws::measured_order([&](int steps) { return error_of(problem, composition, steps); }, problem.steps);
}

Problem<SphericalPendulum> bob() {
  const SphericalPendulum system;
  const State<Pair<3>> start{{0.6, 0, -0.8}, {0.4, 0.7, 0.3}};
  const auto exact = system.reference(start, 5);
  return {system, start, 5, 10, [exact](const auto& end) {
            return (end.state.object - exact.object).norm() + (end.state.momentum - exact.momentum).norm();
          }};
}
Problem<HeavyTop> lagrange_top() {
  HeavyTop system;
  system.inertia << 1, 1, 0.4;
  Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  const auto exact = system.reference(leaning, attitude, 5);
  return {system, leaning, 5, 10, [exact, attitude](const auto& end) {
            return (end.state.object - exact.object).norm() + (end.state.momentum - exact.momentum).norm() +
                   (end.configuration.element - attitude).norm();
          }};
}

/// Compositions of steps, and those of two flows that are for the system.
template <class Sys> std::vector<Composition> all_for(const Sys& system) {
  std::vector<Composition> all(compositions::all.begin(), compositions::all.end());
  for (const auto& of_two_flows : splittings::all)
    if (splits_by(system, of_two_flows)) all.push_back(of_two_flows);
  return all;
}

template <class Sys> void expect_declared_orders(const Problem<Sys>& problem) {
  for (const auto& composition : compositions::all) {
    const auto declared = make(problem.system, problem.start, composition).traits();
    EXPECT_EQ(declared.order, composition.order);
    EXPECT_NEAR(order_of(problem, composition), declared.order, 0.1) << declared.name;
  }
}

TEST(Orders, OfThePendulum) { expect_declared_orders(swing()); }
TEST(Orders, OfKeplersProblem) { expect_declared_orders(orbit()); }
TEST(Orders, OfTheRigidBodyWithItsAttitude) { expect_declared_orders(body()); }
TEST(Orders, OfTheHeavyTopWithItsAttitude) { expect_declared_orders(top()); }
TEST(Orders, OfALagrangeTopWithItsAttitude) { expect_declared_orders(lagrange_top()); }
TEST(Orders, OfTheSphericalPendulum) { expect_declared_orders(bob()); }

/// Their error constants are small: orders show with few steps, and less clearly. After a whole period of an ellipse
/// that of order 4 looks higher, so that the orbit ends elsewhere.
template <class Sys> void expect_declared_orders_of_two_flows(Problem<Sys> problem) {
  problem.steps = 6;
  int asked = 0;
  for (const auto& of_two_flows : splittings::all) {
    if (!splits_by(problem.system, of_two_flows)) continue;
    ++asked;
    EXPECT_NEAR(order_of(problem, of_two_flows), of_two_flows.order, 0.35) << of_two_flows.name;
  }
  EXPECT_GE(asked, 2);
}
TEST(Orders, OfTwoFlows) {
  Problem<Kepler> arc = orbit();
  arc.horizon = 5;
  const auto exact = arc.system.reference(arc.start, arc.horizon);
  arc.error = [exact](const auto& end) {
    return (end.state.object - exact.object).norm() + (end.state.momentum - exact.momentum).norm();
  };
  expect_declared_orders_of_two_flows(arc);
  expect_declared_orders_of_two_flows(swing());
  expect_declared_orders_of_two_flows(bob());
  expect_declared_orders_of_two_flows(body());
  expect_declared_orders_of_two_flows(lagrange_top());
}

TEST(Orders, AreHadOnlyWhereTheSplittingIsForTheSystem) {
  EXPECT_EQ(all_for(Kepler{}).size(), 11u);
  EXPECT_EQ(all_for(SphericalPendulum{}).size(), 11u);
  EXPECT_EQ(all_for(RigidBody{}).size(), 8u) << "its first flow depends on the momentum";
  EXPECT_EQ(all_for(lagrange_top().system).size(), 11u);
  EXPECT_EQ(all_for(asymmetric_top()).size(), 6u) << "three flows";
  EXPECT_THROW(make(RigidBody{}, body().start, splittings::srkn11), std::invalid_argument);
  EXPECT_THROW(make(asymmetric_top(), leaning, splittings::s6), std::invalid_argument);
  // And rightly: taken for one of two flows, three do not have the order.
  struct Careless : HeavyTop {
    bool two_flows() const { return true; }
  };
  Careless careless;
  careless.inertia = asymmetric_top().inertia;
  careless.weight = asymmetric_top().weight;
  Problem<Careless> problem{careless, leaning, 5, 20, {}};
  const auto exact = top();
  problem.error = [&](const auto& end) {
    TrajectoryPoint<HeavyTop> as_top;
    as_top.state = end.state;
    as_top.configuration = end.configuration;
    return exact.error(as_top);
  };
  EXPECT_LT(order_of(problem, splittings::s10), 4.5);
}

/// The angle of the rod from its length, and of the momentum from its tangent plane.
TEST(Flows, OfTheSphericalPendulumStayOnTheSphere) {
  SphericalPendulum system;
  system.h = 0.1;
  system.length = 0.3;
  auto run = make(system, {{0, 0, -0.3}, {0.5, 0.2, 0}}, splittings::srkn14);
  for (int k = 0; k < 100'000; ++k) ASSERT_TRUE(run.advance().converged());
  const auto& z = run.point().state;
  EXPECT_NEAR(z.object.norm(), 0.3, 2e-16);
  EXPECT_LT(std::abs(z.object.dot(z.momentum)), 1e-15 * z.momentum.norm());
}

template <class Sys, int N> double largest_gradient_defect(const Sys& system) {
  double most = 0;
  for (int k = 0; k < 20; ++k) {
    Vector<Dual<double>, N> q;
    for (int i = 0; i < N; ++i) q(i) = 0.3 + 0.1 * k + 0.2 * i;
    Vector<double, N> at;
    for (int i = 0; i < N; ++i) at(i) = q(i).value;
    const Vector<double, N> gradient = system.gradient(at);
    for (int i = 0; i < N; ++i) {
      q(i).derivative = 1;
      most = std::max(most, std::abs(system.potential(q).derivative - gradient(i)) / gradient.norm());
      q(i).derivative = 0;
    }
  }
  return most;
}
TEST(Gradients, AreThoseOfThePotentials) {
  EXPECT_LT((largest_gradient_defect<Kepler, 2>({})), 1e-14);
  EXPECT_LT((largest_gradient_defect<Pendulum, 1>({})), 1e-14);
}

/// The triple jump with its steps in another order.
constexpr std::array<double, 3> lopsided_coefficients{compositions::triple_jump.coefficients[1],
                                                      compositions::triple_jump.coefficients[0],
                                                      compositions::triple_jump.coefficients[2]};
constexpr Composition lopsided{"lopsided", 4, lopsided_coefficients, "none"};

TEST(Orders, OfACompositionThatIsNotSymmetricIsOdd) {
  EXPECT_LT(largest_defect_of_the_conditions(lopsided), 1e-14);
  EXPECT_NEAR(order_of(swing(), lopsided), 3, 0.1);
  EXPECT_NEAR(order_of(top(), lopsided), 3, 0.1);
}

// ---- what steps keep

template <class Sys> double distance_after_return(const Problem<Sys>& problem, const Composition& composition) {
  Sys system = problem.system;
  system.h = 0.05;
  auto there = make(system, problem.start, composition);
  for (int k = 0; k < 100; ++k) EXPECT_TRUE(there.advance().converged());
  system.h = -system.h;
  SplittingIntegrator<Sys> back(system, there.point().state, there.point().configuration, composition);
  for (int k = 0; k < 100; ++k) EXPECT_TRUE(back.advance().converged());
  const auto unit = system.groupoid.unit(problem.start.object);
  return (system.groupoid.coordinates_of_arrow(back.point().configuration) - system.groupoid.coordinates_of_arrow(unit))
             .norm() +
         (back.point().state.momentum - problem.start.momentum).norm();
}

TEST(Splittings, ReturnByStepsBack) {
  for (const auto& composition : splittings::all) {
    EXPECT_LT(distance_after_return(orbit(), composition), 1e-12) << composition.name;
    EXPECT_LT(distance_after_return(lagrange_top(), composition), 1e-12) << composition.name;
    EXPECT_LT(distance_after_return(bob(), composition), 1e-12) << composition.name;
  }
  for (const auto& composition : compositions::all) {
    EXPECT_LT(distance_after_return(swing(), composition), 1e-12) << composition.name;
    EXPECT_LT(distance_after_return(orbit(), composition), 1e-12) << composition.name;
    EXPECT_LT(distance_after_return(body(), composition), 1e-12) << composition.name;
    EXPECT_LT(distance_after_return(top(), composition), 1e-12) << composition.name;
  }
  EXPECT_GT(distance_after_return(top(), lopsided), 1e-6);
}

template <class Sys> double defect_of(const Problem<Sys>& problem, const Composition& composition) {
  return poisson_defect(problem.system.groupoid, {problem.start.object, problem.start.momentum},
                        laws::splitting_map(problem.system, composition, 0.3));
}

TEST(Splittings, ArePoisson) {
  for (const auto& composition : splittings::all) {
    EXPECT_LT(defect_of(orbit(), composition), 1e-14) << composition.name;
    EXPECT_LT(defect_of(lagrange_top(), composition), 1e-14) << composition.name;
  }
  for (const auto& composition : compositions::all) {
    EXPECT_LT(defect_of(swing(), composition), 1e-14) << composition.name;
    EXPECT_LT(defect_of(orbit(), composition), 1e-14) << composition.name;
    EXPECT_LT(defect_of(body(), composition), 1e-14) << composition.name;
    EXPECT_LT(defect_of(top(), composition), 1e-14) << composition.name;
  }
  EXPECT_GT(poisson_defect(Pair<2>{}, {orbit().start.object, orbit().start.momentum},
                           laws::splitting_map(Rubbed{}, compositions::single, 0.3)),
            1e-5);
}

/// The largest deviation of every quantity over the run, by name, relative to its first norm.
template <class Sys>
double drift_of(const std::string& name, const Sys& system, const State<typename Sys::GroupoidType>& start,
                const Composition& composition, long steps) {
  const auto quantities = system.quantities();
  const auto quantity =
      std::find_if(quantities.begin(), quantities.end(), [&](const auto& q) { return q.name == name; });
  if (quantity == quantities.end()) throw std::invalid_argument(name);
  const auto value = [&](const TrajectoryPoint<Sys>& point) {
    Eigen::VectorXd out(quantity->components.size());
    quantity->evaluate(point, out.data());
    return out;
  };
  auto integrator = make(system, start, composition);
  const Eigen::VectorXd first = value(integrator.point());
  double drift = 0;
  for (long k = 0; k < steps; ++k) {
    if (!integrator.advance().converged()) return std::numeric_limits<double>::infinity();
    drift = std::max(drift, (value(integrator.point()) - first).norm() / first.norm());
  }
  return drift;
}

TEST(Splittings, KeepMomenta) {
  // No more than a random walk of round-off.
  constexpr long steps = 100'000;
  const double walk = 20 * std::numeric_limits<double>::epsilon() * std::sqrt(double(steps));
  for (const auto& composition : {compositions::single, compositions::kahan_li_6}) {
    EXPECT_LT(drift_of("angular momentum", Kepler{}, orbit().start, composition, steps), walk);
    EXPECT_LT(drift_of("spatial momentum A M", RigidBody{}, body().start, composition, steps), walk);
    EXPECT_LT(drift_of("vertical momentum M.v", asymmetric_top(), leaning, composition, steps), walk);
    EXPECT_LT(drift_of("axial momentum M3", HeavyTop{}, leaning, composition, steps), walk);
  }
}

TEST(Splittings, KeepNoMomentumOfASymmetryThatAPartBreaks) {
  // The symmetric top, kicked aside.
  HeavyTop top;
  top.weight << 1e-3, 0, 1;
  auto integrator = make(top, leaning, compositions::single);
  for (int k = 0; k < 1000; ++k) ASSERT_TRUE(integrator.advance().converged());
  EXPECT_GT(std::abs(integrator.point().state.momentum(2) - leaning.momentum(2)), 1e-5);
}

TEST(Splittings, KeepTheEnergyInABandThatShrinksWithTheStep) {
  for (const auto& composition : {compositions::single, compositions::suzuki}) {
    std::vector<double> band;
    for (const double h : {0.1, 0.05}) {
      HeavyTop top = asymmetric_top();
      top.h = h;
      band.push_back(drift_of("energy", top, leaning, composition, long(1000 / h)));
    }
    EXPECT_NEAR(std::log2(band[0] / band[1]), composition.order, 0.3) << composition.name;
  }
}

TEST(Splittings, OfASymmetricBodyAreExact) {
  RigidBody system;
  system.inertia << 1, 2, 1;
  system.h = 0.5;
  const State<SO3> start = body().start;
  Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  const auto exact = system.reference(start, attitude, 10);
  auto integrator = make(system, start, compositions::single);
  for (int k = 0; k < 20; ++k) ASSERT_TRUE(integrator.advance().converged());
  EXPECT_LT((integrator.point().state.momentum - exact.momentum).norm(), 1e-12);
  EXPECT_LT((integrator.point().configuration - attitude).norm(), 1e-12);
}

// ---- against the implicit steps, and at their limits

template <class Sys> double distance_from_the_trapezoid(Sys system, const State<typename Sys::GroupoidType>& start) {
  system.h = 0.05;
  system.quadrature = Quadrature::trapezoid;
  auto explicitly = make(system, start, compositions::single);
  FixedStepIntegrator<Sys> implicitly(system, start, system.groupoid.unit(start.object),
                                      std::make_unique<NewtonStep<Sys>>());
  double distance = 0;
  for (int k = 0; k < 1000; ++k) {
    EXPECT_TRUE(explicitly.advance().converged());
    EXPECT_TRUE(implicitly.advance().converged());
    const auto& a = explicitly.point().state;
    const auto& b = implicitly.point().state;
    distance = std::max(distance, (a.object - b.object).norm() + (a.momentum - b.momentum).norm());
  }
  return distance;
}

TEST(StormerVerlet, IsTheStepOfTheTrapezoid) {
  EXPECT_LT(distance_from_the_trapezoid(Pendulum{}, swing().start), 1e-12);
  EXPECT_LT(distance_from_the_trapezoid(Kepler{}, orbit().start), 1e-11);
}

TEST(Splittings, AllocateNothing) {
  if (allocation_count() < 0) GTEST_SKIP() << "not counted under AddressSanitizer";
  const auto count = [](const auto& problem) {
    auto integrator = make(problem.system, problem.start, compositions::kahan_li_8);
    const long before = allocation_count();
    for (int k = 0; k < 100; ++k) EXPECT_TRUE(integrator.advance().converged());
    return allocation_count() - before;
  };
  EXPECT_EQ(count(swing()), 0);
  EXPECT_EQ(count(orbit()), 0);
  EXPECT_EQ(count(body()), 0);
  EXPECT_EQ(count(top()), 0);
}

TEST(Splittings, DoNotAdvanceIntoASingularity) {
  const State<Pair<2>> centre{{0, 0}, {0, 1}};
  auto integrator = make(Kepler{}, centre, compositions::single);
  EXPECT_EQ(integrator.advance().status, SolveStatus::not_finite);
  EXPECT_EQ(integrator.point().index, 0);
  EXPECT_EQ(integrator.point().state.momentum, centre.momentum);
}

}  // namespace
