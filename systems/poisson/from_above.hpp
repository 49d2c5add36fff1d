#pragma once
/// Steps on the dual of a Lie algebra, or another reduced Poisson manifold, beside those of the mechanical system that
/// it is reduced from: both ways are taken from the same start, and compared where they meet.
///
///     const std::vector<FromAbove> both = reductions_from_above(1000);  // both[0].largest is about 1e-14
///
/// Discrete Euler-Poincare equations with L = h l(tau^{-1}(g) / h) are steps of the symplectic groupoid in the chart of
/// the same tau; a heavy top's trapezoidal potential is a part of a splitting; Stormer and Verlet's method on Toda's
/// lattice is the splitting of Flaschka's variables. Returns the largest difference over the steps, relative to the
/// state, and what each way takes. Errors: std::runtime_error for a step that does not converge.

#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/poisson/poisson_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/systems/poisson/lattices.hpp>
#include <lagroid/systems/poisson/rotations.hpp>
#include <lagroid/systems/poisson/toda_row.hpp>
#include <lagroid/systems/poisson/tops.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

struct FromAbove {
  std::string above;    ///< the mechanical system
  std::string bracket;  ///< the reduced one, and its steps
  double largest = 0;   ///< difference, relative to the largest number of the state
  double microseconds_above = 0;
  double microseconds_bracket = 0;  ///< a step
};

namespace detail {

/// Steps both ways: `above` and `below` step once and return the reduced state.
inline void compare_from_above(FromAbove& out, long steps, const std::function<Eigen::VectorXd()>& above,
                               const std::function<Eigen::VectorXd()>& below) {
  using Clock = std::chrono::steady_clock;
  const auto timed = [&](const auto& step, double& microseconds) {
    std::vector<Eigen::VectorXd> states;
    const auto start = Clock::now();
    for (long k = 0; k < steps; ++k) states.push_back(step());
    microseconds = std::chrono::duration<double, std::micro>(Clock::now() - start).count() / double(steps);
    return states;
  };
  const auto upper = timed(above, out.microseconds_above), lower = timed(below, out.microseconds_bracket);
  for (std::size_t k = 0; k < upper.size(); ++k)
    out.largest = std::max(out.largest, (upper[k] - lower[k]).cwiseAbs().maxCoeff() / upper[k].cwiseAbs().maxCoeff());
}

/// A step of a discrete Lagrangian, and then what `reduced` makes of the state.
template <class Sys>
std::function<Eigen::VectorXd()> steps_above(
    const Sys& system, const State<typename Sys::GroupoidType>& start,
    const std::function<Eigen::VectorXd(const State<typename Sys::GroupoidType>&)>& reduced) {
  const auto motion = std::make_shared<FixedStepIntegrator<Sys>>(system, start, system.groupoid.unit(start.object),
                                                                 std::make_unique<NewtonStep<Sys>>());
  return [motion, reduced] {
    if (!motion->advance().converged()) throw std::runtime_error("a step of the unreduced system did not converge");
    return reduced(motion->point().state);
  };
}
template <class Sys>
std::function<Eigen::VectorXd()> steps_below(const Sys& system, const Vector<double, Sys::dimension>& start,
                                             const PoissonOptions& options,
                                             const std::function<void(PoissonIntegrator&)>& beside = nullptr) {
  const std::shared_ptr<PoissonIntegrator> motion = make_poisson_integrator(system, start, options);
  return [motion, beside] {
    if (beside) beside(*motion);
    if (!motion->advance().converged()) throw std::runtime_error("a step of the reduced system did not converge");
    if (beside) beside(*motion);
    const std::vector<double> x = motion->point();
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(x.data(), Eigen::Index(x.size())));
  };
}

}  // namespace detail

/// A rigid body by both maps from so(3), a heavy top, and Toda's lattice of four particles.
inline std::vector<FromAbove> reductions_from_above(long steps) {
  constexpr double h = 0.05;
  std::vector<FromAbove> out;
  const auto compare = [&](std::string above, std::string bracket, const auto& upper, const auto& lower) {
    out.push_back({std::move(above), std::move(bracket)});
    detail::compare_from_above(out.back(), steps, upper, lower);
  };

  const Vector<double, 3> momentum(0.8, 0.6, 1.1);
  RigidBody body;
  body.h = h;
  const EulerTop top;
  const State<SO3> at_rest{{}, momentum};
  const auto of_body = [](const State<SO3>& s) { return Eigen::VectorXd(s.momentum); };
  compare("rigid body on SO(3), exponential map", "euler_top, karasev",
          detail::steps_above<RigidBody>(body, at_rest, of_body),
          detail::steps_below(top, momentum, {.method = "karasev", .step = h}));
  body.rotation = RotationMap::cayley;
  compare("rigid body on SO(3), Cayley map", "euler_top, symplectic-groupoid",
          detail::steps_above<RigidBody>(body, at_rest, of_body),
          detail::steps_below(top, momentum, {.method = "symplectic-groupoid", .step = h}));

  HeavyTop heavy;
  heavy.h = h;
  heavy.inertia = {1, 1.3, 0.6};
  heavy.weight = {0.1, -0.2, 0.9};
  HeavyTopBracket free;
  free.inertia = heavy.inertia;
  free.weight.setZero();
  const Vector<double, 3> vertical(0, 0.6, 0.8);
  Vector<double, 6> start;
  start << momentum, vertical;
  // The potential alone moves M by gamma x w.
  const auto half_kick = [w = heavy.weight](PoissonIntegrator& motion) {
    std::vector<double> x = motion.point();
    Eigen::Map<Vector<double, 3>>(x.data()) += 0.5 * h * Vector<double, 3>(x[3], x[4], x[5]).cross(w);
    motion.go_on_from(x);
  };
  compare("heavy top on SO(3) acting on S^2", "heavy_top_bracket, karasev between halves of the potential",
          detail::steps_above<HeavyTop>(heavy, {vertical, momentum},
                                        [](const auto& s) {
                                          Eigen::VectorXd x(6);
                                          x << s.momentum, s.object;
                                          return x;
                                        }),
          detail::steps_below(free, start, {.method = "karasev", .step = h}, half_kick));

  TodaRow<4> row;
  row.h = h;
  const State<Pair<4>> particles{{0.3, 0.1, -0.2, 0}, {0.2, -0.4, 0.1, 0.3}};
  compare("Toda's lattice of four particles", "toda, splitting",
          detail::steps_above<TodaRow<4>>(
              row, particles, [](const auto& s) { return Eigen::VectorXd(flaschka<4>(s.object, s.momentum)); }),
          detail::steps_below(OpenToda<4>(), flaschka<4>(particles.object, particles.momentum),
                              {.method = "splitting", .step = h}));
  return out;
}

}  // namespace lagroid
