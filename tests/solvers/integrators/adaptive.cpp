// Steps that keep the discrete energy ([G] Example 6.1): where they do, where they cannot, and what then; reversible
// control of the step size.
#include <lagroid/core/capabilities/discrete_energy.hpp>
#include <lagroid/solvers/integrators/integrator_methods.hpp>
#include <lagroid/systems/control/group_control.hpp>
#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/driven_pendulum.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rolling/rolling_ball.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace lagroid;

namespace integrators_adaptive_tests {
namespace {

/// l = (xi1^2 + 2 xi2^2) / 2 with xi3 = c on SO(3): the constraint is not homogeneous.
struct Spinning : GroupControl<Spinning, SO3, 1> {
  double rate = 0.4;
  template <class S> S l(const Vector<S, 3>& xi) const { return (xi(0) * xi(0) + xi(1) * xi(1) * 2) * 0.5; }
  template <class S> Vector<S, 1> psi(const Vector<S, 3>& xi) const { return Vector<S, 1>(xi(2) - rate); }
  Control<3, 1> control(const Vector<double, 3>& mu) const {
    return {{mu(0), mu(1) / 2, rate}, Vector<double, 1>(mu(2))};
  }
};

/// l = |xi|^2 / 2 with exp: E_d does not depend on the step.
struct Sphere : GroupControl<Sphere, SO3> {
  template <class S> S l(const Vector<S, 3>& xi) const { return xi.squaredNorm() * 0.5; }
  Control<3, 0> control(const Vector<double, 3>& mu) const { return {mu, {}}; }
};

template <class Sys> struct Start {
  Sys system;
  State<typename Sys::GroupoidType> state;
};

Start<Pendulum> pendulum(Quadrature quadrature, double angle, double momentum, double h = 0.2) {
  Start<Pendulum> s{{}, {Vector<double, 1>(angle), Vector<double, 1>(momentum)}};
  s.system.h = h;
  s.system.quadrature = quadrature;
  return s;
}
Start<Kepler> kepler(Quadrature quadrature, double e, double h = 0.05) {
  Start<Kepler> s{{}, {{1 - e, 0}, {0, std::sqrt((1 + e) / (1 - e))}}};
  s.system.h = h;
  s.system.quadrature = quadrature;
  return s;
}
Start<RigidBody> rigid_body(RotationMap map) {
  Start<RigidBody> s{{}, {{}, {0.3, 1.5, 0.4}}};
  s.system.h = 0.1;
  s.system.rotation = map;
  return s;
}
Start<HeavyTop> heavy_top(RotationMap map) {
  Start<HeavyTop> s{{}, {Vector<double, 3>(0.36, 0.48, 0.8), {0.5, 1.1, 0.8}}};
  s.system.inertia << 1, 2, 3;
  s.system.weight << 0.1, 0.2, 1;
  s.system.h = 0.05;
  s.system.rotation = map;
  return s;
}
Start<PlateBall> plate_ball(RotationForm form) {
  Start<PlateBall> s;
  s.system.spin = 0.4;
  s.system.h = 0.1;
  s.system.rotation = form;
  std::get<0>(s.state.object) << 0.3, -0.2;
  s.state.momentum << 0.9, 0.2, 0.6, -0.3, 0.5;
  return s;
}

Start<SphericalPendulum> swinging(double h = 0.02) {
  Start<SphericalPendulum> s{{}, {{0.6, 0, -0.8}, {0.4, 0.5, 0.3}}};
  s.system.h = h;
  return s;
}

/// U = q^2 / 2.
struct Harmonic : MechanicalSystem<Harmonic, 1> {
  static double mass() { return 1; }
  template <class S> S potential(const Vector<S, 1>& q) const { return q(0) * q(0) * 0.5; }
};

struct Outcome {
  StepReport last;
  long steps = 0;
  double energy_error = 0;  ///< largest |E_d - E_d(first)| / |E_d|
  double smallest = 1e300;
  double largest = 0;
  long without_root = 0;
  double time = 0;
  double energy = 0;
};

template <class Sys>
std::unique_ptr<Integrator<Sys>> make(const Start<Sys>& s, WithoutRoot policy = WithoutRoot::stop,
                                      StepMethod method = StepMethod::newton) {
  IntegratorOptions options;
  options.mode = TimeMode::adaptive;
  options.without_root = policy;
  options.method = method;
  return make_integrator(s.system, s.state, s.system.groupoid.unit(s.state.object), options);
}

template <class Sys>
Outcome run(const Start<Sys>& s, int steps, WithoutRoot policy = WithoutRoot::stop,
            StepMethod method = StepMethod::newton) {
  const auto integrator = make(s, policy, method);
  Outcome out;
  for (int k = 0; k < steps; ++k) {
    out.last = integrator->advance();
    if (!out.last.converged()) break;
    const auto& p = integrator->point();
    out.steps = p.index;
    out.smallest = std::min(out.smallest, p.step_size);
    out.largest = std::max(out.largest, p.step_size);
    const double energy = discrete_energy(s.system, p.step, p.time - p.step_size, p.step_size);
    if (k == 0) out.energy = energy;
    out.energy_error = std::max(out.energy_error, std::abs(energy - out.energy) / std::abs(out.energy));
    EXPECT_TRUE(p.state.momentum.allFinite());
    EXPECT_GT(p.step_size, 0);
  }
  out.without_root = integrator->without_root();
  out.time = integrator->point().time;
  return out;
}

// ../shared/cases/plate-ball.json, PA1 and PA2.
TEST(Adaptive, PendulumOfTheReferenceNumbers) {
  const auto integrator = make(pendulum(Quadrature::midpoint, std::acos(0.5), 0));
  for (int k = 1; k <= 100; ++k) {
    ASSERT_TRUE(integrator->advance().converged()) << k;
    const double expected = k == 2   ? 0.199922901930149877
                            : k == 3 ? 0.199350310023102096
                                     : integrator->point().step_size;
    EXPECT_NEAR(integrator->point().step_size, expected, 1e-10);
  }
  const auto& p = integrator->point();
  EXPECT_NEAR(run(pendulum(Quadrature::midpoint, std::acos(0.5), 0), 1).energy, -0.503731251046227347, 1e-14);
  EXPECT_NEAR(p.state.object(0), 0.635892914308174266, 1e-10);
  EXPECT_NEAR(p.state.momentum(0), 0.780625488664801581, 1e-10);
  EXPECT_NEAR(p.time, 19.2711878175280657, 1e-10);
  EXPECT_NEAR(p.step_size, 0.190420392355723342, 1e-10);
}
TEST(Adaptive, RigidBodyOfTheReferenceNumbers) {
  const auto integrator = make(rigid_body(RotationMap::cayley));
  for (int k = 1; k <= 50; ++k) ASSERT_TRUE(integrator->advance().converged()) << k;
  const auto& p = integrator->point();
  EXPECT_NEAR(run(rigid_body(RotationMap::cayley), 1).energy, 0.632020010364338698, 1e-14);
  const Vector<double, 3> end(0.350136834584743513, 1.45596025486724956, -0.507527273468007503);
  EXPECT_LT((p.state.momentum - end).norm(), 1e-10);
  EXPECT_NEAR(p.time, 5.03722011358415016, 1e-10);
  EXPECT_NEAR(p.step_size, 0.0992465101295610398, 1e-10);
}

// Both solvers follow the same steps.
TEST(Adaptive, CeresAgreesWithNewton) {
  const auto s = rigid_body(RotationMap::cayley);
  const Outcome newton = run(s, 50);
  const Outcome ceres = run(s, 50, WithoutRoot::stop, StepMethod::ceres);
  ASSERT_TRUE(ceres.last.converged()) << to_string(ceres.last.status);
  EXPECT_NEAR(ceres.time, newton.time, 1e-9);
}

// The demonstrations: E_d to round-off over 3000 steps whose sizes do vary.
template <class Sys> void expect_energy_kept(const Start<Sys>& s) {
  const Outcome out = run(s, 3000);
  EXPECT_EQ(out.steps, 3000) << to_string(out.last.status);
  EXPECT_LT(out.energy_error, 1e-12);
  EXPECT_GT(out.largest / out.smallest, 1.001);
}
TEST(Adaptive, KeepsTheEnergyOfThePendulum) { expect_energy_kept(pendulum(Quadrature::midpoint, std::acos(0.5), 0)); }
TEST(Adaptive, KeepsTheEnergyOfKeplerOrbits) {
  expect_energy_kept(kepler(Quadrature::midpoint, 0.2));
  expect_energy_kept(kepler(Quadrature::midpoint, 0.6));
}
TEST(Adaptive, KeepsTheEnergyOfTheRigidBody) {
  expect_energy_kept(rigid_body(RotationMap::exponential));
  expect_energy_kept(rigid_body(RotationMap::cayley));
}
TEST(Adaptive, KeepsTheEnergyOfAnAsymmetricTop) { expect_energy_kept(heavy_top(RotationMap::cayley)); }
TEST(Adaptive, KeepsTheEnergyOfThePlateBall) {
  expect_energy_kept(plate_ball(RotationForm::exponential));
  expect_energy_kept(plate_ball(RotationForm::cayley));
}

// l(xi) - <dl, xi> - <lambda, dpsi xi> + <lambda, psi>: without the multiplier's term it is not conserved.
TEST(Adaptive, TheMultiplierBelongsToTheEnergy) {
  Start<Spinning> s;
  s.system.h = 0.1;
  s.state.momentum << 0.9, 0.7, 0.5;
  const auto integrator = make(s);
  double with = 0;
  double without = 0;
  double first_with = 0;
  double first_without = 0;
  for (int k = 0; k < 3000; ++k) {
    ASSERT_TRUE(integrator->advance().converged()) << k;
    const auto& p = integrator->point();
    const double energy = discrete_energy(s.system, p.step, 0, p.step_size);
    const double printed = energy - s.system.rate * p.step.multipliers(0);
    if (k == 0) first_with = energy;
    if (k == 0) first_without = printed;
    with = std::max(with, std::abs(energy - first_with));
    without = std::max(without, std::abs(printed - first_without));
  }
  EXPECT_LT(with, 1e-13);
  EXPECT_GT(without, 1e-2);
}

// The honest failures: a typed outcome after a few steps.
template <class Sys> void expect_no_step(const Start<Sys>& s, long most) {
  const Outcome out = run(s, 3000);
  EXPECT_EQ(out.last.status, SolveStatus::no_step) << to_string(out.last.status) << " after " << out.steps;
  EXPECT_LE(out.steps, most);
  EXPECT_GE(out.steps, 1);
  EXPECT_LT(out.energy_error, 1e-12);
}
TEST(Adaptive, SaysSoWhereNoStepKeepsTheEnergy) {
  expect_no_step(pendulum(Quadrature::trapezoid, std::acos(0.5), 0), 10);
  expect_no_step(pendulum(Quadrature::midpoint, 0, 2.5), 10);
  Start<Harmonic> harmonic{{}, {Vector<double, 1>(1.0), Vector<double, 1>(0.0)}};
  harmonic.system.h = 0.2;
  harmonic.system.quadrature = Quadrature::trapezoid;
  expect_no_step(harmonic, 10);
  expect_no_step(kepler(Quadrature::trapezoid, 0.6), 20);
  expect_no_step(heavy_top(RotationMap::exponential), 300);
  expect_no_step(plate_ball(RotationForm::trace), 300);
}
TEST(Adaptive, SaysSoWhereTheEnergyDoesNotDependOnTheStep) {
  Start<Sphere> s;
  s.system.h = 0.1;
  s.state.momentum << 0.3, 0.8, -0.2;
  const Outcome out = run(s, 10);
  EXPECT_EQ(out.last.status, SolveStatus::degenerate);
  EXPECT_EQ(out.steps, 0);
}

// What the user chose for such steps: all are taken, and counted.
TEST(Adaptive, CarriesOnAsChosen) {
  for (const auto policy : {WithoutRoot::constant, WithoutRoot::controlled}) {
    const auto s = pendulum(Quadrature::midpoint, 0, 2.5, 0.05);
    const Outcome out = run(s, 1000, policy);
    EXPECT_EQ(out.steps, 1000) << to_string(out.last.status);
    EXPECT_GT(out.without_root, 0);
    EXPECT_LT(out.without_root, 1000);
    EXPECT_LT(out.energy_error, 1e-3);
  }
}

// A driven motion: the discrete energy balance p_t is kept, not E_d.
TEST(Adaptive, DrivenMotionsAreSolvedOrRefused) {
  Start<DrivenPendulum> s{{}, {Vector<double, 1>(1.2), Vector<double, 1>(0.3)}};
  s.system.h = 0.1;
  s.system.torque = 0.05;
  s.system.frequency = 0.7;
  const auto integrator = make(s, WithoutRoot::constant);
  FreeTime<DrivenPendulum> extended(s.system);
  double arrived = 0;  // p_t at the end of the step before
  double change = 0;
  for (int k = 0; k < 200; ++k) {
    const long off = integrator->without_root();
    ASSERT_TRUE(integrator->advance().converged()) << k;
    const auto& p = integrator->point();
    extended.origin = p.time - p.step_size;
    const auto d = gradients(
        extended, {PairArrow<double, 1>{Vector<double, 1>(0.0), Vector<double, 1>(p.step_size)}, p.step.arrow}, {});
    if (k > 0 && integrator->without_root() == off) {
      EXPECT_NEAR(-d.source_gradient(0), arrived, 1e-12) << k;
    }
    arrived = d.target_gradient(0);
    change = std::max(change, std::abs(d.target_gradient(0) + d.source_gradient(0)));
  }
  EXPECT_GT(change, 1e-4) << "the drive changes p_t";
  EXPECT_LT(integrator->without_root(), 100);
}

// A change of sign of E_d(h) - E_d at the rim of what is searched, or where E_d jumps, is no step: no other failure.
TEST(Adaptive, RotationsOfThePendulumFindAStepOrSayThatThereIsNone) {
  int without = 0;
  for (const double momentum : {1.8, 2.1, 2.4})
    for (const double angle : {0.0, 1.0, 2.0})
      for (const double h : {0.05, 0.1, 0.2}) {
        const Outcome out = run(pendulum(Quadrature::midpoint, angle, momentum, h), 300);
        EXPECT_TRUE(out.last.converged() || out.last.status == SolveStatus::no_step)
            << to_string(out.last.status) << ": " << angle << ' ' << momentum << ' ' << h;
        without += !out.last.converged();
      }
  EXPECT_GT(without, 0);
}
// Where the motion changes too fast for the control to go on, it begins anew.
TEST(Adaptive, ControlInsteadCarriesThroughACloseApproach) {
  const Outcome out = run(kepler(Quadrature::midpoint, 0.9, 0.03), 500, WithoutRoot::controlled);
  EXPECT_EQ(out.steps, 500) << to_string(out.last.status);
}

// ---- control

template <class Sys> std::unique_ptr<Integrator<Sys>> controlled(const Start<Sys>& s) {
  IntegratorOptions options;
  options.mode = TimeMode::controlled;
  return make_integrator(s.system, s.state, s.system.groupoid.unit(s.state.object), options);
}

template <class Sys>
double rate_defect(const Start<Sys>& s, const std::function<double(const TrajectoryPoint<Sys>&)>& log_scale) {
  Start<Sys> fine = s;
  fine.system.h = 1e-3;
  FixedStepIntegrator<Sys> run(fine.system, s.state, s.system.groupoid.unit(s.state.object),
                               std::make_unique<NewtonStep<Sys>>());
  const auto log_scale_here = [&] {
    auto point = run.point();
    point.state.momentum = tangent_momentum(s.system, point.state);
    return log_scale(point);
  };
  const double first = log_scale_here();
  EXPECT_TRUE(run.advance().converged());
  const double rate = time_scale_rate(s.system, run.point().state);
  EXPECT_TRUE(run.advance().converged());
  return std::abs((log_scale_here() - first) / 2e-3 - rate);
}
TEST(Controlled, TimeScaleRatesAreTheRatesOfTheirScales) {
  EXPECT_LT(rate_defect<Pendulum>(pendulum(Quadrature::midpoint, 1.0, 0.7),
                                  [](const auto& p) { return -0.5 * std::log(1 + p.state.momentum.squaredNorm()); }),
            1e-5);
  EXPECT_LT(rate_defect<SphericalPendulum>(
                swinging(), [](const auto& p) { return -0.5 * std::log(1 + p.state.momentum.squaredNorm()); }),
            1e-5);
  EXPECT_LT(rate_defect<Kepler>({{}, {{0.7, 0.1}, {0.2, 1.1}}},
                                [](const auto& p) { return 1.5 * std::log(p.state.object.norm()); }),
            1e-5);
  const auto body = rigid_body(RotationMap::cayley);
  EXPECT_LT(
      rate_defect<RigidBody>(
          body, [&](const auto& p) { return -std::log(p.state.momentum.cwiseQuotient(body.system.inertia).norm()); }),
      1e-5);
  auto ball = plate_ball(RotationForm::exponential);
  ball.system.plate_rate = 0.7;
  EXPECT_LT(rate_defect<PlateBall>(
                ball,
                [&](const auto& p) {
                  const auto& q = std::get<0>(p.state.object);
                  const auto& mu = p.state.momentum;
                  const Vector<double, 2> v(mu(0) + mu(3), mu(1) - mu(2));
                  return -std::log(Vector<double, 3>(0.7 * q(0) - v(1), v(0) + 0.7 * q(1), ball.system.spin).norm());
                }),
            1e-5);
  const auto top = heavy_top(RotationMap::cayley);
  EXPECT_LT(rate_defect<HeavyTop>(top,
                                  [&](const auto& p) {
                                    return -0.5 *
                                           std::log(top.system.weight.norm() / top.system.inertia.maxCoeff() +
                                                    p.state.momentum.cwiseQuotient(top.system.inertia).squaredNorm());
                                  }),
            1e-5);
}

/// As many steps back from a point as it is away from the start, beginning with the density there, end at the start.
template <class Sys> void expect_return(const Start<Sys>& s, const TrajectoryPoint<Sys>& there) {
  const double half_change = 0.5 * time_scale_rate(s.system, there.state);
  Start<Sys> turned = s;
  turned.system.h = 1 / (1 / there.step_size - half_change);
  turned.state = {there.state.object, -tangent_momentum(s.system, there.state)};
  const auto back = controlled(turned);
  for (long k = 0; k < there.index; ++k) ASSERT_TRUE(back->advance().converged());
  const auto& here = back->point().state;
  EXPECT_LT((here.object - s.state.object).norm() + (tangent_momentum(s.system, here) + s.state.momentum).norm(), 1e-9);
  EXPECT_NEAR(back->point().time, there.time, 1e-9);
}

// The step follows |q|^(3/2); and back again, from the density at the end: the control is reversible.
TEST(Controlled, FollowsTheTimeScaleAndReturns) {
  const auto s = kepler(Quadrature::trapezoid, 0.6, 0.02);
  const auto out = controlled(s);
  double smallest = 1;
  double largest = 0;
  for (int k = 0; k < 500; ++k) {
    ASSERT_TRUE(out->advance().converged());
    smallest = std::min(smallest, out->point().step_size);
    largest = std::max(largest, out->point().step_size);
    EXPECT_NEAR(out->point().step_size / std::pow(out->point().state.object.norm() / 0.4, 1.5) / 0.02, 1, 0.1);
  }
  EXPECT_GT(largest / smallest, 3);
  expect_return(s, out->point());
}
TEST(Controlled, ReturnsWithObjectConstraints) {
  const auto s = swinging();
  const auto out = controlled(s);
  for (int k = 0; k < 500; ++k) ASSERT_TRUE(out->advance().converged());
  EXPECT_GT(std::abs(out->point().step_size / s.system.h - 1), 0.01);
  expect_return(s, out->point());
}

// Over twenty orbits with e = 0.9: the energy errs less than with as many equal steps.
TEST(Controlled, BeatsEqualStepsOnAnEccentricOrbit) {
  constexpr double horizon = 40 * std::numbers::pi;
  const auto energy_error = [&](Integrator<Kepler>& integrator, const Start<Kepler>& s) {
    double worst = 0;
    while (integrator.point().time < horizon) {
      EXPECT_TRUE(integrator.advance().converged());
      worst = std::max(worst, std::abs(s.system.energy(integrator.point().state) - s.system.energy(s.state)));
    }
    return worst;
  };
  auto s = kepler(Quadrature::trapezoid, 0.9, 0.0025);
  const auto with = controlled(s);
  const double error = energy_error(*with, s);
  s.system.h = horizon / double(with->point().index);
  const auto without = make_integrator(s.system, s.state, s.system.groupoid.unit(s.state.object), {});
  EXPECT_LT(5 * error, energy_error(*without, s));
}

/// A pendulum that keeps its step to itself, as reductions run upwards do.
struct WithoutStep : System<WithoutStep, Pair<1>> {
  Pendulum pendulum;
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const { return pendulum.lagrangian(g); }
};
TEST(HigherOrders, AreRefusedWhereThereIsNoStepToCompose) {
  const WithoutStep system;
  IntegratorOptions options;
  const State<Pair<1>> start{Vector<double, 1>(1.2), Vector<double, 1>(0.3)};
  EXPECT_NO_THROW(make_integrator(system, start, system.groupoid.unit(start.object), options));
  options.composition = compositions::kahan_li_6;
  EXPECT_THROW(make_integrator(system, start, system.groupoid.unit(start.object), options), std::invalid_argument);
}

/// One step of h against two of h / 2, relative to the motion of the momentum and object, as reported.
template <class Sys> double step_error(Start<Sys> s, double h) {
  const auto end = [&](double size, int steps) {
    s.system.h = size;
    const auto integrator = make_integrator(s.system, s.state, s.system.groupoid.unit(s.state.object), {});
    for (int k = 0; k < steps; ++k) EXPECT_TRUE(integrator->advance().converged());
    return integrator->point();
  };
  const auto once = end(h, 1);
  const auto twice = end(0.5 * h, 2);
  const auto& groupoid = s.system.groupoid;
  const auto between =
      groupoid.tau_inverse(groupoid.multiply(groupoid.inverse(once.configuration), twice.configuration));
  const auto momentum = tangent_momentum(s.system, twice.state);
  return std::max(between.norm() / groupoid.tau_inverse(twice.configuration).norm(),
                  (tangent_momentum(s.system, once.state) - momentum).norm() / momentum.norm());
}
template <class Sys> void expect_first_step(Start<Sys> s, double accuracy) {
  s.system.h = 0.01;
  const double h = step_for_accuracy(s.system, s.state, accuracy, {});
  ASSERT_GT(h, 0);
  const double error = step_error(s, h);
  EXPECT_LT(error, 1.5 * accuracy) << h;
  EXPECT_GT(error, 0.5 * accuracy) << h;
}
TEST(FirstStep, HasTheAccuracyAskedFor) {
  for (const double accuracy : {1e-3, 1e-6}) {
    expect_first_step(kepler(Quadrature::trapezoid, 0.6), accuracy);
    expect_first_step(swinging(), accuracy);
    expect_first_step(rigid_body(RotationMap::cayley), accuracy);
    RollingBall ball;
    ball.plate_rate = 0.7;
    expect_first_step(Start<RollingBall>{ball, ball.rolling({0.3, -0.2}, {0.4, 0.1}, 0.7)}, accuracy);
  }
}
TEST(FirstStep, GrowsWithTheSquareRootOfTheAccuracy) {
  const auto s = kepler(Quadrature::trapezoid, 0.6, 0.1);
  const double coarse = step_for_accuracy(s.system, s.state, 1e-6, {});
  const double fine = step_for_accuracy(s.system, s.state, 1e-9, {});
  EXPECT_GT(coarse, 0);
  EXPECT_NEAR(coarse / fine, std::sqrt(1000), 2) << "the error of a step, O(h^3), over the motion, O(h)";
}

}  // namespace
}  // namespace integrators_adaptive_tests
