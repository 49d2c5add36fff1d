// Numbers that are none, in states and parameters: no NaN leaves the library.
#include "support/hard_case.hpp"
#include "support/refusal.hpp"

#include <lagroid/solvers/boundary/boundary_values.hpp>
#include <lagroid/solvers/integrators/integrator.hpp>
#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/multibody/effects.hpp>
#include <lagroid/systems/multibody/joints.hpp>
#include <lagroid/systems/multibody/multibody.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>
#include <lagroid/systems/rotations/moser_veselov.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <cmath>
#include <stdexcept>

namespace lagroid::hard {
namespace {

using V2 = Vector<double, 2>;
using V3 = Vector<double, 3>;
using multibody::Body;
using multibody::Multibody;
using multibody::Scene;

const std::initializer_list<double> none{not_a_number, infinite, -infinite};

template <class Sys>
double refused(const Sys& system, const State<typename Sys::GroupoidType>& start, const IntegratorOptions& options) {
  return refusal(*make_integrator(system, start, system.groupoid.unit(start.object), options));
}
IntegratorOptions by(StepMethod method) {
  IntegratorOptions options;
  options.method = method;
  return options;
}
IntegratorOptions by_splitting() {
  IntegratorOptions options;
  options.fixed = StepKind::splitting;
  return options;
}

/// Each momentum, place and parameter in turn.
double in_states(const IntegratorOptions& options, bool implicit_only) {
  double sum = 0;
  for (const double x : none) {
    sum += refused(Kepler{}, {V2(1, 0), V2(0, x)}, options);
    sum += refused(Kepler{}, {V2(x, 0), V2(0, 1)}, options);
    State<SO3> turning;
    turning.momentum << 0.3, x, 0.4;
    sum += refused(RigidBody{}, turning, options);
    sum += refused(HeavyTop{}, {V3(0, 0, 1), V3(0.3, x, 0.4)}, options);
    sum += refused(HeavyTop{}, {V3(0, x, 1), V3(0.3, 1, 0.4)}, options);
    if (!implicit_only) continue;
    sum += refused(SphericalPendulum{}, {V3(0.6, 0, -0.8), V3(0, x, 0)}, options);
    sum += refused(SphericalPendulum{}, {V3(0.6, x, -0.8), V3(0, 1, 0)}, options);
    State<PlateBall::GroupoidType> ball;
    std::get<0>(ball.object) << 0.3, -0.2;
    ball.momentum << 0.9, 0.2, 0.6, -0.4, x;
    sum += refused(PlateBall{}, ball, options);
    std::get<0>(ball.object)(1) = x;
    ball.momentum(4) = 0.8;
    sum += refused(PlateBall{}, ball, options);
  }
  return sum;
}
double in_parameters(const IntegratorOptions& options) {
  double sum = 0;
  for (const double x : {not_a_number, infinite}) {
    Kepler kepler;
    kepler.strength = x;
    sum += refused(kepler, {V2(1, 0), V2(0, 1)}, options);
    HeavyTop top;
    top.weight = V3(0, 0, x);
    sum += refused(top, {V3(0.6, 0, 0.8), V3(0.3, 1, 0.4)}, options);
  }
  RigidBody body;
  body.inertia(1) = not_a_number;
  State<SO3> turning;
  turning.momentum << 0.3, 1, 0.4;
  sum += refused(body, turning, options);
  return sum;
}
double in_moser_veselov() {
  double sum = 0;
  for (const double x : none) {
    State<SO3> turning;
    turning.momentum << 0.3, x, 0.4;
    sum += refused(MoserVeselov{}, turning, {});
    try {
      MoserVeselov::preprocessed({1, 2, 3}, turning.momentum, 0.1, 10);
      sum += 1;
    } catch (const std::invalid_argument&) {
    }
  }
  return sum;
}

/// Scenes with a mass, a force, a velocity, a spin that is no number: refused when they begin, or at the first step.
double in_scenes() {
  double sum = 0;
  for (const double x : none)
    for (int place = 0; place < 5; ++place) {
      const auto value = [&](int here, double otherwise) { return place == here ? x : otherwise; };
      try {
        Scene scene;
        const Body bob = scene.point_mass(1, {1, 0, value(0, 0)}, {0, value(1, 1), 0});
        const Body top = scene.rigid_body(1, {1, 2, 3}, {0, 1, 0}, {1, 0, 0, 0}, {0, 0, 0}, {0.3, value(2, 1), 0.2});
        scene.add(multibody::ConstantForce{{bob.centre}, {0, 0, value(3, -9.81)}});
        scene.add(multibody::Rod{{scene.ground({0, 0, 0}), bob.centre}, value(4, 1)});
        scene.add(multibody::Spring{{top.centre, bob.centre}, 3, 1});
        Multibody motion(std::move(scene), 0.01);
        const auto before = motion.state();
        const bool taken = motion.advance().converged();
        const auto after = motion.state();
        const bool same = before.index == after.index && same_bits(before.at.x[0], after.at.x[0]) &&
                          same_bits(before.momentum[0], after.momentum[0]) && same_bits(before.spin[0], after.spin[0]);
        sum += taken || !same ? 1 : 0;
      } catch (const std::invalid_argument&) {
      }
    }
  return sum;
}

/// An end or a parameter that is no number: an exception, or a typed status; never a solution.
double in_boundary_values() {
  double sum = 0;
  for (const double x : none) {
    const BoundaryProblem<Kepler> ends{Kepler{}, {V2(1, 0), V2(-0.3, x)}};
    try {
      solve_boundary(*make_boundary_solver<Kepler>(), ends, 20);
      sum += 1;
    } catch (const std::invalid_argument&) {
    }
    for (const auto method : {BoundaryMethod::newton, BoundaryMethod::shooting, BoundaryMethod::ceres}) {
      Kepler system;
      system.h = 0.05;
      BoundaryProblem<Kepler> problem{system, {V2(1, 0), V2(-0.3, 0.8)}};
      const auto path = geodesic_path(problem, 20);
      problem.system.strength = x;
      const auto found = make_boundary_solver<Kepler>(method)->solve(problem, path, false);
      sum += found.converged() ? 1 : 0;
    }
  }
  return sum;
}

/// A step of explicit Euler takes what it is given: the place after it.
double taken_as_it_comes() { return (V2(1, 0) + 0.01 * V2(0, not_a_number)).norm(); }
/// The same with the check that is often written, x > limit, which a NaN passes.
double checked_by_comparison() {
  const double x = not_a_number;
  return x > 1e10 ? 0 : x;
}

}  // namespace

std::vector<HardCase> bad_input() {
  const char* const promise = "not supported: a typed status, and nothing moves (violations)";
  return {
      {"StatesByNewton", "NaN or infinite places and momenta, steps by Newton's iteration", promise,
       "explicit Euler: place after a step", 0, [] { return in_states({}, true); }, taken_as_it_comes},
      {"StatesByCeres", "the same, steps by Ceres", promise, "explicit Euler: place after a step", 0,
       [] { return in_states(by(StepMethod::ceres), true); }, taken_as_it_comes},
      {"StatesBySplitting", "the same, explicit steps", promise, "explicit Euler: place after a step", 0,
       [] { return in_states(by_splitting(), false); }, taken_as_it_comes},
      {"ParametersByNewton", "NaN or infinite parameters, steps by Newton's iteration", promise,
       "explicit Euler: place after a step", 0, [] { return in_parameters({}); }, taken_as_it_comes},
      {"ParametersBySplitting", "the same, explicit steps", promise, "explicit Euler: place after a step", 0,
       [] { return in_parameters(by_splitting()); }, taken_as_it_comes},
      {"MoserVeselov", "NaN or infinite momenta, Moser-Veselov and its preprocessing", promise,
       "explicit Euler: place after a step", 0, in_moser_veselov, taken_as_it_comes},
      {"Scenes", "NaN or infinite places, velocities, spins, forces and lengths in scenes of bodies",
       "not supported: an exception or a typed status, and nothing moves (violations)",
       "a comparison x > limit, which lets a NaN pass: what is left", 0, in_scenes, checked_by_comparison},
      {"BoundaryValues", "NaN or infinite ends and parameters, by Newton, shooting and Ceres",
       "not supported: an exception or a typed status (violations)",
       "a comparison x > limit, which lets a NaN pass: what is left", 0, in_boundary_values, checked_by_comparison},
  };
}

}  // namespace lagroid::hard
