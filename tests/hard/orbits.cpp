// Close approach to an attracting centre.
#include "support/hard_case.hpp"
#include "support/naive.hpp"
#include "support/refusal.hpp"

#include <lagroid/core/capabilities/discrete_energy.hpp>
#include <lagroid/solvers/integrators/integrator.hpp>
#include <lagroid/systems/kepler.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace lagroid::hard {
namespace {

using V2 = Vector<double, 2>;
constexpr double period = 2 * std::numbers::pi;

/// From the far end of an ellipse of unit half axis.
State<Pair<2>> far_end(double e) { return {V2(1 + e, 0), V2(0, std::sqrt((1 - e) / (1 + e)))}; }

std::unique_ptr<Integrator<Kepler>> orbit(const State<Pair<2>>& start, double h, TimeMode mode) {
  Kepler system;
  system.quadrature = Quadrature::midpoint;
  system.h = h;
  IntegratorOptions options;
  options.mode = mode;
  return make_integrator(system, start, system.groupoid.unit(start.object), options);
}

struct Round {
  int steps = 0;
  double position = not_a_number;  ///< distance from the exact ellipse at the end, over the half axis
  double energy = not_a_number;    ///< largest error, relative
  double far = not_a_number;       ///< of the energy where the orbit ends
  double momentum = not_a_number;  ///< of the angular momentum, relative
  double discrete = not_a_number;  ///< of the discrete energy, relative
};
/// Once round: until the time of a period has passed.
Round round(double e, double h, TimeMode mode, double duration = period) {
  const auto start = far_end(e);
  Kepler system;
  system.quadrature = Quadrature::midpoint;
  const auto integrator = orbit(start, h, mode);
  const double energy = system.energy(start);
  const double momentum = start.object(0) * start.momentum(1);
  double first = not_a_number;
  Round out{0, 0, 0, 0, 0, 0};
  while (integrator->point().time < duration) {
    if (!integrator->advance().converged() || out.steps > 10'000'000) return {};
    ++out.steps;
    const auto& p = integrator->point();
    const double now = p.state.object(0) * p.state.momentum(1) - p.state.object(1) * p.state.momentum(0);
    out.momentum = worse(out.momentum, std::abs(now / momentum - 1));
    out.far = std::abs(system.energy(p.state) / energy - 1);
    out.energy = worse(out.energy, out.far);
    const double over = discrete_energy(system, p.step, 0, p.step_size);
    if (out.steps == 1) first = over;
    out.discrete = worse(out.discrete, std::abs(over / first - 1));
  }
  const auto exact = system.reference(start, integrator->point().time);
  out.position = (integrator->point().state.object - exact.object).norm();
  return out;
}

/// Equal steps of Stormer and Verlet, as many as the other run took.
Round equally(double e, const Round& other) {
  const auto start = far_end(e);
  Kepler system;
  system.quadrature = Quadrature::midpoint;
  system.h = period / other.steps;
  IntegratorOptions options;
  options.fixed = StepKind::splitting;
  const auto integrator = make_integrator(system, start, system.groupoid.unit(start.object), options);
  Round out{0, 0, 0, 0, 0, 0};
  double first = not_a_number;
  for (; out.steps < other.steps; ++out.steps) {
    if (!integrator->advance().converged()) return {};
    const auto& p = integrator->point();
    out.far = std::abs(system.energy(p.state) / system.energy(start) - 1);
    out.energy = worse(out.energy, out.far);
    const double over = discrete_energy(system, p.step, 0, p.step_size);
    if (out.steps == 0) first = over;
    out.discrete = worse(out.discrete, std::abs(over / first - 1));
  }
  out.position = (integrator->point().state.object - start.object).norm();
  return out;
}

/// A fall from rest into the centre: 0 where it ends in a typed status that leaves everything finite, and its last
/// point as it was.
double fall(TimeMode mode) {
  const auto integrator = orbit({V2(1, 0), V2(0, 0)}, 0.01, mode);
  for (int k = 0; k < 100'000; ++k) {
    const auto before = integrator->point();
    if (integrator->advance().converged()) continue;
    const auto& p = integrator->point();
    return unmoved(before, p) && p.state.object.allFinite() && p.state.momentum.allFinite() ? 0 : 1;
  }
  return 1;
}
/// The error of the energy after a fall by steps of Stormer and Verlet, which pass through the centre.
double fall_through() {
  Kepler system;
  IntegratorOptions options;
  options.fixed = StepKind::splitting;
  const State<Pair<2>> start{V2(1, 0), V2(0, 0)};
  const auto integrator = make_integrator(system, start, system.groupoid.unit(start.object), options);
  for (int k = 0; k < 200; ++k) integrator->advance();
  return std::abs(system.energy(integrator->point().state) / system.energy(start) - 1);
}

/// A step that would begin at the centre itself.
double from_the_centre(bool splitting) {
  Kepler system;
  IntegratorOptions options;
  options.fixed = splitting ? StepKind::splitting : StepKind::variational;
  system.quadrature = Quadrature::trapezoid;
  const State<Pair<2>> start{V2(0, 0), V2(1, 0)};
  return refusal(*make_integrator(system, start, system.groupoid.unit(start.object), options));
}

/// Adaptive steps along an orbit on which the energy equation has no root: 0 where the integrator says `no_step` there,
/// and all its steps before have kept the discrete energy.
double without_a_root() {
  const auto integrator = orbit(far_end(0.99), 0.01, TimeMode::adaptive);
  Kepler system;
  system.quadrature = Quadrature::midpoint;
  double first = not_a_number;
  double worst = 0;
  for (int k = 0; k < 100'000; ++k) {
    const auto before = integrator->point();
    const SolveStatus status = integrator->advance().status;
    if (status != SolveStatus::converged)
      return status == SolveStatus::no_step && unmoved(before, integrator->point()) ? worst : not_a_number;
    const double over = discrete_energy(system, integrator->point().step, 0, integrator->point().step_size);
    if (k == 0) first = over;
    worst = worse(worst, std::abs(over / first - 1));
  }
  return not_a_number;
}

}  // namespace

std::vector<HardCase> orbits() {
  return {
      {"ControlledStepsReturn", "Kepler, e = 0.99, once round by controlled steps", "error of the place, half axes",
       "as many equal steps", 1e-2, [] { return round(0.99, 0.02, TimeMode::controlled).position; },
       [] { return equally(0.99, round(0.99, 0.02, TimeMode::controlled)).position; }},
      {"ControlledStepsReturnTheEnergy", "the same", "relative error of the energy on return", "as many equal steps",
       1e-5, [] { return round(0.99, 0.02, TimeMode::controlled).far; },
       [] { return equally(0.99, round(0.99, 0.02, TimeMode::controlled)).far; }},
      {"AdaptiveStepsKeepTheEnergy", "Kepler, e = 0.6, once round by adaptive steps",
       "relative change of the discrete energy", "as many equal steps", 1e-12,
       [] { return round(0.6, 0.01, TimeMode::adaptive).discrete; },
       [] { return equally(0.6, round(0.6, 0.01, TimeMode::adaptive)).discrete; }},
      {"AdaptiveStepsWithoutARoot", "Kepler, e = 0.99 by adaptive steps: no step keeps the energy all the way round",
       "not supported: `no_step`, and up to there the discrete energy is kept (its relative change)",
       "as many equal steps as controlled ones", 1e-12, without_a_root,
       [] { return equally(0.99, round(0.99, 0.02, TimeMode::controlled)).discrete; }},
      {"NearCollision", "Kepler, e = 0.999, once round by controlled steps", "error of the place, half axes",
       "as many equal steps", 1e-2, [] { return round(0.999, 0.02, TimeMode::controlled).position; },
       [] { return equally(0.999, round(0.999, 0.02, TimeMode::controlled)).position; }},
      {"AngularMomentum", "Kepler, e = 0.99 and 0.999, controlled steps", "relative error of the angular momentum",
       "Runge-Kutta of order 4, as many equal steps", 1e-13,
       [] {
         return worse(round(0.99, 0.02, TimeMode::controlled).momentum,
                      round(0.999, 0.02, TimeMode::controlled).momentum);
       },
       [] {
         const Field equations = [](const Eigen::VectorXd& y) {
           Eigen::VectorXd out(4);
           out << y.tail<2>(), -y.head<2>() / std::pow(y.head<2>().norm(), 3);
           return out;
         };
         const auto start = far_end(0.99);
         Eigen::VectorXd y(4);
         y << start.object, start.momentum;
         const int steps = round(0.99, 0.02, TimeMode::controlled).steps;
         for (int k = 0; k < steps; ++k) y = runge_kutta_step(equations, y, period / steps);
         const double first = start.object(0) * start.momentum(1);
         return std::abs((y(0) * y(3) - y(1) * y(2)) / first - 1);
       }},
      {"RadialFall", "Kepler, at rest: a fall into the centre, by equal, adaptive and controlled steps",
       "not supported: a typed status, all finite, and nothing moves (0: so)",
       "steps of Stormer and Verlet go through the centre: relative error of the energy", 0,
       [] { return fall(TimeMode::fixed) + fall(TimeMode::adaptive) + fall(TimeMode::controlled); }, fall_through},
      {"FromTheCentre", "Kepler, at the centre itself, by implicit steps and by splitting",
       "not supported: a typed status, and nothing moves (0: so)", "the force -q / |q|^3 there", 0,
       [] { return from_the_centre(false) + from_the_centre(true); },
       [] {
         const V2 q(0, 0);
         return (-q / std::pow(q.norm(), 3)).norm();
       }},
  };
}

}  // namespace lagroid::hard
