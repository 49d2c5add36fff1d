// Steps far too large, far too small, and of no size at all.
#include "support/hard_case.hpp"
#include "support/naive.hpp"
#include "support/refusal.hpp"

#include <lagroid/core/derivatives/step_equations.hpp>
#include <lagroid/core/scalars/compensation.hpp>
#include <lagroid/solvers/integrators/integrator.hpp>
#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rolling/chaplygin_sleigh.hpp>
#include <lagroid/systems/rolling/rolling_ball.hpp>
#include <lagroid/systems/rolling/rolling_disk.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace lagroid::hard {
namespace {

using V1 = Vector<double, 1>;
using V2 = Vector<double, 2>;
using V3 = Vector<double, 3>;
constexpr double eps = std::numeric_limits<double>::epsilon();

template <class Sys>
auto integrator_from(Sys system, double h, const State<typename Sys::GroupoidType>& start,
                     const IntegratorOptions& options = {}) {
  system.h = h;
  return make_integrator(system, start, system.groupoid.unit(start.object), options);
}

/// After one step: the defect of the step equations, relative to the momentum and the gradients; zero where the step
/// was refused by a typed status and nothing has moved; NaN where anything else came of it.
template <class Sys> double solved_or_refused(Sys system, double h, const State<typename Sys::GroupoidType>& start) {
  system.h = h;
  const auto integrator = integrator_from(system, h, start);
  const auto before = integrator->point();
  const bool taken = integrator->advance().converged();
  const auto& p = integrator->point();
  if (!taken) return unmoved(before, p) ? 0 : not_a_number;
  if (!p.state.momentum.allFinite()) return not_a_number;
  using E = StepEquations<Sys>;
  const auto residual = E::residual(gradients(system, p.step.arrow, p.step.multipliers), start.momentum);
  const auto jacobian = E::jacobian(two_sided(system, p.step.arrow, p.step.multipliers));
  return residual.cwiseAbs().cwiseQuotient(round_off_level(system, start, p.step, jacobian)).maxCoeff();
}
const std::initializer_list<double> large{1e2, 1e4, 1e8, 1e16, -1e4};

template <class Sys> double over_large(const Sys& system, const State<typename Sys::GroupoidType>& start) {
  double worst = 0;
  for (const double h : large) worst = worse(worst, solved_or_refused(system, h, start));
  return worst;
}
/// Twenty sweeps of q' = q + h (p + p') / 2, p' = p + h f((q + q') / 2), not asked whether they settle: the defect.
double sweeps(double h, const std::function<double(double)>& force, double q, double p) {
  double q1 = q;
  double p1 = p;
  for (int k = 0; k < 20; ++k) {
    p1 = p + h * force(0.5 * (q + q1));
    q1 = q + 0.5 * h * (p + p1);
  }
  return std::abs(q1 - q - 0.5 * h * (p + p + h * force(0.5 * (q + q1)))) / (1 + std::abs(q1)) / eps;
}
double pendulum_sweeps() {
  return sweeps(
      1e4, [](double q) { return -std::sin(q); }, 1, 0.3);
}
/// The same for a body: I w = dexp^T mu.
double body_sweeps(double h, const V3& inertia, const V3& momentum) {
  V3 xi = h * momentum.cwiseQuotient(inertia);
  for (int k = 0; k < 20; ++k) xi = (h * (SO3::dexp(V3(-xi)).transpose() * momentum)).eval().cwiseQuotient(inertia);
  return (SO3::dexp_inverse(V3(-xi)).transpose() * inertia.cwiseProduct(xi) / h - momentum).norm() / momentum.norm() /
         eps;
}

State<PlateBall::GroupoidType> ball() {
  State<PlateBall::GroupoidType> out;
  std::get<0>(out.object) << 0.3, -0.2;
  out.momentum << 0.9, 0.2, 0.6, -0.4, 0.8;
  return out;
}
double plate_ball(RotationForm form) {
  PlateBall system;
  system.plate_rate = 0.5;
  system.rotation = form;
  return over_large(system, ball());
}

/// Steps of 1e-9 s along an orbit: time, place and angular momentum against the exact ones, in units of round-off.
constexpr double tiny = 1e-9;
constexpr int tiny_steps = 100'000;
const State<Pair<2>> apse{V2(1, 0), V2(0, 1.1)};

struct Tiny {
  double time = 0;
  double place = 0;
  double energy = 0;
};
/// The exact end, by Runge and Kutta in extended precision: (q, p).
const Vector<double, 4>& exact_end() {
  static const Vector<double, 4> end = [] {
    using Long = Vector<long double, 4>;
    const auto rate = [](const Long& y) {
      const long double r = y.head<2>().norm();
      Long out;
      out << y.tail<2>(), -y.head<2>() / (r * r * r);
      return out;
    };
    Long y;
    y << apse.object.cast<long double>(), apse.momentum.cast<long double>();
    constexpr long double h = static_cast<long double>(tiny) * tiny_steps / 1000;
    for (int k = 0; k < 1000; ++k) {
      const Long a = rate(y);
      const Long b = rate(y + h / 2 * a);
      const Long c = rate(y + h / 2 * b);
      const Long d = rate(y + h * c);
      y += h / 6 * (a + 2 * b + 2 * c + d);
    }
    return Vector<double, 4>(y.cast<double>());
  }();
  return end;
}
Tiny tiny_defects(double time, const V2& q, const V2& p) {
  constexpr double end = tiny * tiny_steps;
  const Kepler system;
  return {std::abs(time / end - 1) / eps,
          worse((q - exact_end().head<2>()).norm(), (p - exact_end().tail<2>()).norm()) / eps,
          std::abs(system.energy({q, p}) / system.energy(apse) - 1) / eps};
}
Tiny by_integrator(bool splitting) {
  IntegratorOptions options;
  options.fixed = splitting ? StepKind::splitting : StepKind::variational;
  const auto integrator = integrator_from(Kepler{}, tiny, apse, options);
  for (int k = 0; k < tiny_steps; ++k)
    if (!integrator->advance().converged()) return {not_a_number, not_a_number, not_a_number};
  const auto& p = integrator->point();
  return tiny_defects(p.time, p.state.object, p.state.momentum);
}
Tiny by_controlled() {
  IntegratorOptions options;
  options.mode = TimeMode::controlled;
  const auto integrator = integrator_from(Kepler{}, tiny, apse, options);
  double sum = 0;
  Compensation<double> compensation{};
  for (int k = 0; k < tiny_steps; ++k) {
    if (!integrator->advance().converged()) return {not_a_number, not_a_number, not_a_number};
    compensation.add(sum, integrator->point().step_size);
  }
  return {std::abs(integrator->point().time / sum - 1) / eps, 0, 0};
}
/// The same steps of Stormer and Verlet in plain sums.
Tiny by_plain_sums() {
  V2 q = apse.object;
  V2 p = apse.momentum;
  double time = 0;
  for (int k = 0; k < tiny_steps; ++k) {
    p -= 0.5 * tiny / std::pow(q.norm(), 3) * q;
    q += tiny * p;
    p -= 0.5 * tiny / std::pow(q.norm(), 3) * q;
    time += tiny;
  }
  return tiny_defects(time, q, p);
}

/// There and back by negative steps: distance from the start.
template <class Sys> double there_and_back(const Sys& system, const State<typename Sys::GroupoidType>& start) {
  const auto there = integrator_from(system, 0.05, start);
  for (int k = 0; k < 1000; ++k)
    if (!there->advance().converged()) return not_a_number;
  const auto back = integrator_from(system, -0.05, there->point().state);
  for (int k = 0; k < 1000; ++k)
    if (!back->advance().converged()) return not_a_number;
  const auto& end = back->point().state;
  return worse(
      (system.groupoid.coordinates_of_object(end.object) - system.groupoid.coordinates_of_object(start.object)).norm(),
      (end.momentum - start.momentum).norm());
}
double there_and_back_by_runge_kutta() {
  const Field equations = [](const Eigen::VectorXd& y) {
    Eigen::VectorXd out(4);
    out << y.tail<2>(), -y.head<2>() / std::pow(y.head<2>().norm(), 3);
    return out;
  };
  Eigen::VectorXd y(4);
  y << apse.object, apse.momentum;
  const Eigen::VectorXd first = y;
  for (const double h : {0.05, -0.05})
    for (int k = 0; k < 1000; ++k) y = runge_kutta_step(equations, y, h);
  return (y - first).norm();
}

/// 0 where a step of that size either is refused, nothing moving, or (of size zero) stays where it is.
template <class Sys>
double refused_or_at_rest(const Sys& system, double h, const State<typename Sys::GroupoidType>& start,
                          const IntegratorOptions& options = {}) {
  const auto integrator = integrator_from(system, h, start, options);
  const auto before = integrator->point();
  const bool taken = integrator->advance().converged();
  const auto& p = integrator->point();
  if (!taken) return unmoved(before, p) ? 0 : 1;
  return h == 0 && p.time == before.time && same_bits(p.state.momentum, start.momentum) ? 0 : 1;
}
double strange(double h) {
  IntegratorOptions splitting;
  splitting.fixed = StepKind::splitting;
  IntegratorOptions controlled;
  controlled.mode = TimeMode::controlled;
  IntegratorOptions adaptive;
  adaptive.mode = TimeMode::adaptive;
  double sum = 0;
  for (const auto& options : {IntegratorOptions{}, splitting, controlled, adaptive})
    sum += refused_or_at_rest(Kepler{}, h, apse, options);
  State<SO3> turning;
  turning.momentum << 0.3, 1.5, 0.4;
  for (const auto& options : {IntegratorOptions{}, splitting, controlled, adaptive})
    sum += refused_or_at_rest(RigidBody{}, h, turning, options);
  sum += refused_or_at_rest(PlateBall{}, h, ball());
  sum += refused_or_at_rest(SphericalPendulum{}, h, {V3(0.6, 0, -0.8), V3(0, 0.9, 0)});
  return sum;
}

}  // namespace

std::vector<HardCase> steps() {
  const char* const defect =
      "defect of the step equations in units of their round-off, or a typed refusal that moves nothing";
  const char* const swept = "20 sweeps of a fixed-point iteration";
  const V3 inertia(1, 2, 3);
  const V3 momentum(0.3, 1.5, 0.4);
  return {
      {"LargePendulum", "pendulum, h = 1e2 to 1e16 and -1e4 s", defect, swept, 100,
       [] {
         return over_large(Pendulum{}, {V1(1.0), V1(0.3)});
       },
       pendulum_sweeps},
      {"LargeKepler", "Kepler, the same steps", defect,
       "explicit Euler: relative error of the energy, in units of epsilon", 100,
       [] {
         return over_large(Kepler{}, {V2(1, 0), V2(0.1, 1.1)});
       },
       [] {
         Kepler system;
         const State<Pair<2>> start{V2(1, 0), V2(0.1, 1.1)};
         const State<Pair<2>> end{start.object + 1e4 * start.momentum, start.momentum - 1e4 * start.object};
         return std::abs(system.energy(end) / system.energy(start) - 1) / eps;
       }},
      {"LargeRigidBody", "rigid body, by exp and by Cayley, the same steps", defect, swept, 100,
       [] {
         State<SO3> start;
         start.momentum << 0.3, 1.5, 0.4;
         RigidBody cayley;
         cayley.rotation = RotationMap::cayley;
         return worse(over_large(RigidBody{}, start), over_large(cayley, start));
       },
       [inertia, momentum] { return body_sweeps(1e4, inertia, momentum); }},
      {"LargeHeavyTop", "heavy top, the same steps", defect, swept, 100,
       [] {
         return over_large(HeavyTop{}, {V3(0.6, 0, 0.8), V3(0.3, 1.5, 0.4)});
       },
       [momentum] { return body_sweeps(1e4, V3(1, 1, 0.5), momentum); }},
      {"LargeSphericalPendulum", "spherical pendulum, the same steps", defect,
       "the multiplier from the linearised constraint: error of the rod, in units of epsilon", 100,
       [] {
         return over_large(SphericalPendulum{}, {V3(0.6, 0, -0.8), V3(0, 0.9, 0)});
       },
       [] {
         const V3 q(0.6, 0, -0.8);
         const V3 free = q + 1e4 * V3(0, 0.9, 0);
         return std::abs((free - q * (free.dot(q) - 1)).norm() - 1) / eps;
       }},
      {"LargePlateBall", "plate-ball, all three forms, the same steps", defect, "20 sweeps, of the ball's turn", 100,
       [] {
         return worse(plate_ball(RotationForm::trace),
                      worse(plate_ball(RotationForm::exponential), plate_ball(RotationForm::cayley)));
       },
       [] { return body_sweeps(1e4, V3(0.4, 0.5, 0.6), V3(0.6, -0.4, 0.8)); }},
      {"LargeNonholonomic", "rolling ball, rolling disk, sleigh, the same steps", defect, swept, 100,
       [] {
         RollingBall rolling;
         rolling.plate_rate = 0.7;
         ChaplyginSleigh sleigh;
         RollingDisk disk;
         return worse(over_large(rolling, rolling.rolling({0.3, -0.2}, {0.4, 0.1}, 0.7)),
                      worse(over_large(sleigh, sleigh.sliding(0.8, 0.3)), over_large(disk, disk.rolling(0.5, 0.7))));
       },
       pendulum_sweeps},
      {"TinyStepsTime", "1e5 steps of 1e-9 s, equal and controlled", "relative error of the time, in units of epsilon",
       "t += h", 2, [] { return worse(by_integrator(false).time, by_controlled().time); },
       [] { return by_plain_sums().time; }},
      {"TinyStepsPlace", "Kepler, 1e5 explicit steps of 1e-9 s (Stormer and Verlet)",
       "error of place and momentum, in units of epsilon", "the same steps in plain sums", 2,
       [] { return by_integrator(true).place; }, [] { return by_plain_sums().place; }},
      {"TinyStepsEnergy", "the same", "relative error of the energy, in units of epsilon",
       "the same steps in plain sums", 4, [] { return by_integrator(true).energy; },
       [] { return by_plain_sums().energy; }},
      {"TinyImplicitSteps", "Kepler, 1e5 implicit steps of 1e-9 s",
       "error of place and momentum, in units of eps sqrt(n): a random walk",
       "momenta as differences of stored places over h", 2,
       [] { return by_integrator(false).place / std::sqrt(double(tiny_steps)); },
       [] {
         IntegratorOptions options;
         options.fixed = StepKind::splitting;
         const auto integrator = integrator_from(Kepler{}, tiny, apse, options);
         V2 before = apse.object;
         double worst = 0;
         for (int k = 0; k < 1000; ++k) {
           integrator->advance();
           const V2 now = integrator->point().state.object;
           worst = worse(worst, ((now - before) / tiny - integrator->point().state.momentum).norm());
           before = now;
         }
         return worst / eps / std::sqrt(double(tiny_steps));
       }},
      {"NegativeSteps", "Kepler and heavy top, 1000 steps there, 1000 back", "distance from the start",
       "Runge-Kutta of order 4", 1e-11,
       [] {
         return worse(there_and_back(Kepler{}, apse), there_and_back(HeavyTop{}, {V3(0.6, 0, 0.8), V3(0.3, 1.5, 0.4)}));
       },
       there_and_back_by_runge_kutta},
      {"ZeroSteps", "h = 0, every way of stepping", "refused, or at rest; nothing moves (0: so)",
       "velocity as a difference over h", 0, [] { return strange(0); },
       [] {
         const volatile double h = 0;
         return (V2(1, 0) - V2(1, 0)).norm() / h;
       }},
      {"StepsThatAreNoNumbers", "h = NaN and infinite, every way of stepping",
       "not supported: a typed status, and nothing moves (0: so)", "explicit Euler", 0,
       [] { return strange(not_a_number) + strange(infinite); },
       [] { return (apse.object + not_a_number * apse.momentum).norm(); }},
  };
}

}  // namespace lagroid::hard
