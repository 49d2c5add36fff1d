// Boundary values whose ends are conjugate, or out of reach.
#include "support/hard_case.hpp"

#include <lagroid/solvers/boundary/boundary_values.hpp>
#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace lagroid::hard {
namespace {

using V1 = Vector<double, 1>;
using V2 = Vector<double, 2>;
using V3 = Vector<double, 3>;

/// The pendulum's swing of the discrete half period: h w / 2 = tan(pi / (2 N)), where the linearised motion from the
/// lowest point is back there.
constexpr std::size_t arrows = 40;
Pendulum conjugate(double factor) {
  Pendulum system;
  system.h = 0.05;
  const double w = factor * 2 / system.h * std::tan(std::numbers::pi / (2 * double(arrows)));
  system.gravity = w * w;
  return system;
}
/// 0 where the rest between conjugate ends is told from the isolated, least one that it is before; 1 where not.
double named() {
  const auto solved = [](double factor) {
    const Pendulum system = conjugate(factor);
    const BoundaryProblem<Pendulum> problem{system, {V1(0.0), V1(0.0)}};
    return make_boundary_solver<Pendulum>()->solve(problem, geodesic_path(problem, arrows), false);
  };
  const auto before = solved(0.9);
  const auto at = solved(1);
  const auto after = solved(1.1);
  const bool told = !at.converged() || !at.kind.isolated;
  return before.converged() && before.kind.isolated && before.kind.is_minimum && told && after.converged() &&
                 after.kind.negative_directions == 1
             ? 0
             : 1;
}
/// What the determinant of the tridiagonal matrix of second differences says of it: its sign, told by Gauss's
/// elimination without a tolerance, is that of an isolated point.
double determinant_tells() {
  const Pendulum system = conjugate(1);
  const double a = 2 / system.h - 0.5 * system.h * system.gravity;
  const double b = -1 / system.h - 0.25 * system.h * system.gravity;
  double pivot = a;
  for (std::size_t k = 2; k < arrows; ++k) pivot = a - b * b / pivot;
  return pivot == 0 ? 0 : 1;
}

/// Ends near conjugate ones: the residual of what is called converged, or nothing where it is not.
double near_conjugate() {
  double worst = 0;
  for (const double factor : {1 - 1e-6, 1 - 1e-9, 1 + 1e-9, 1 + 1e-6}) {
    const BoundaryProblem<Pendulum> problem{conjugate(factor), {V1(0.0), V1(1e-3)}};
    const auto found = make_boundary_solver<Pendulum>()->solve(problem, geodesic_path(problem, arrows), false);
    if (!found.converged()) continue;
    double defect = 0;
    for (std::size_t k = 1; k < found.path.size(); ++k) {
      const auto plus = legendre_plus(problem.system, found.path[k - 1]).momentum;
      const auto minus = legendre_minus(problem.system, found.path[k]).momentum;
      defect = worse(defect, (plus - minus).norm() / (1 + plus.norm()));
    }
    worst = worse(worst, defect);
  }
  return worst;
}
/// The linearised path instead: its residual in the pendulum's equations.
double near_conjugate_linearised() {
  const Pendulum system = conjugate(1 - 1e-9);
  // q_k = c sin(k theta) through 1e-3 at the end, where sin is tiny.
  const double theta = 2 * std::atan(0.5 * system.h * std::sqrt(system.gravity));
  const double c = 1e-3 / std::sin(double(arrows) * theta);
  double defect = 0;
  for (std::size_t k = 1; k < arrows; ++k) {
    const auto q = [&](std::size_t i) { return c * std::sin(double(i) * theta); };
    const double force =
        -0.5 * system.gravity * (std::sin(0.5 * (q(k) + q(k - 1))) + std::sin(0.5 * (q(k) + q(k + 1))));
    defect = worse(defect, std::abs((q(k + 1) - 2 * q(k) + q(k - 1)) / system.h - system.h * force) /
                               (1 + std::abs(q(k + 1) - q(k)) / system.h));
  }
  return defect;
}

/// A ball that turns once and is as it was: about any axis, a family. 0 where the path is not called isolated.
double family() {
  RigidBody system;
  system.inertia = {2, 2, 2};
  system.h = 0.05;
  BoundaryProblem<RigidBody> problem{system, Matrix<double, 3, 3>::Identity()};
  Path<RigidBody> path(arrows);
  const V3 turn = 2 * std::numbers::pi / double(arrows) * V3(0.6, 0, 0.8);
  for (auto& step : path) step.arrow = SO3::exp(turn);
  const auto found = make_boundary_solver<RigidBody>()->solve(problem, path, false);
  return !found.converged() || !found.kind.isolated ? 0 : 1;
}

/// 0 where ends off the rod are refused by an exception.
double off_the_rod() {
  const BoundaryProblem<SphericalPendulum> problem{SphericalPendulum{}, {V3(0.6, 0, -0.8), V3(0, 1.1, 0)}};
  try {
    solve_boundary(*make_boundary_solver<SphericalPendulum>(), problem, 20);
  } catch (const std::invalid_argument&) {
    return 0;
  }
  return 1;
}

/// Ends that no path of the trace form joins, whose steps turn by less than a right angle: 0 where nothing is called a
/// solution, and every path that is left is finite.
double out_of_reach() {
  PlateBall system;
  system.rotation = RotationForm::trace;
  system.h = 0.1;
  system.spin = 12;  // spin * step > 1
  const ArrowOf<PlateBall::GroupoidType> ends{PairArrow<double, 2>{{0.2, -0.1}, {1, 0.5}},
                                              SO3::exp(V3(0.6, -0.3, 0.9))};
  const BoundaryProblem<PlateBall> problem{system, ends};
  Path<PlateBall> path;
  for (const auto& arrow : system.path(ends, 10, Eigen::Matrix2Xd::Zero(2, 1)))
    path.push_back({arrow, PlateBall::Multipliers::Zero()});
  const auto found = make_boundary_solver<PlateBall>()->solve(problem, path, false);
  for (const auto& step : found.path)
    if (!std::get<1>(step.arrow).allFinite()) return 1;
  return found.converged() ? 1 : 0;
}
/// The rolling constraint solved for the turn by asin.
double out_of_reach_by_sine() { return std::asin(0.1 * 12); }

/// Half an orbit to the opposite side of the centre, Lambert's degenerate case in space but not in the plane: the
/// straight guess goes through the centre. 0 where every solution is one, by its equations.
double opposite() {
  Kepler system;
  system.h = 0.05;
  const BoundaryProblem<Kepler> problem{system, {V2(1, 0), V2(-1, 0)}};
  MultistartOptions options;
  options.starts = 10;
  const auto found = solve_boundary(*make_boundary_solver<Kepler>(), problem, 60, options);
  double worst = 0;
  for (const auto& solution : found.solutions)
    for (std::size_t k = 1; k < solution.path.size(); ++k) {
      const V2 plus = legendre_plus(system, solution.path[k - 1]).momentum;
      const V2 minus = legendre_minus(system, solution.path[k]).momentum;
      worst = worse(worst, (plus - minus).norm() / (1 + plus.norm()));
    }
  return worst;
}
/// The straight path through the centre: the same defect.
double straight() {
  Kepler system;
  system.h = 0.05;
  const BoundaryProblem<Kepler> problem{system, {V2(1, 0), V2(-1, 0)}};
  const auto path = geodesic_path(problem, 60);
  double worst = 0;
  for (std::size_t k = 1; k < path.size(); ++k) {
    const V2 plus = legendre_plus(system, path[k - 1]).momentum;
    const V2 minus = legendre_minus(system, path[k]).momentum;
    worst = worse(worst, (plus - minus).norm() / (1 + plus.norm()));
  }
  return worst;
}

}  // namespace

std::vector<HardCase> boundary_values() {
  return {
      {"ConjugateEnds", "pendulum from its lowest point to there, over the half period of small swings",
       "not called isolated (or typed); before it a minimum, after it one negative direction (0: so)",
       "the last pivot of Gauss's elimination, compared with zero: called regular", 0, named, determinant_tells},
      {"NearlyConjugateEnds", "the same, 1e-6 and 1e-9 beside it, ends 1e-3 apart",
       "defect of the equations of what is called converged", "the linearised path", 1e-8, near_conjugate,
       near_conjugate_linearised},
      {"FamilyOfPaths", "a ball that turns once about any axis", "not called isolated (0: so)",
       "the path of one axis, called the solution: its distance from another's, rad", 0, family,
       [] { return (2 * std::numbers::pi * (V3(0.6, 0, 0.8) - V3(0.8, 0, 0.6))).norm(); }},
      {"EndsOffTheRod", "spherical pendulum, an end off its sphere", "not supported: refused by an exception (0: so)",
       "nothing checked: by how much the end misses the rod, m", 0, off_the_rod,
       [] { return std::abs(V3(0, 1.1, 0).norm() - 1); }},
      {"EndsOutOfReach", "plate-ball in the trace form, spin times step 1.2",
       "not supported: nothing called a solution, all finite (0: so)", "asin of the sine", 0, out_of_reach,
       out_of_reach_by_sine},
      {"OppositeEnds", "Kepler, ends opposite each other: the straight guess meets the centre",
       "defect of the equations of every solution", "the straight path", 1e-9, opposite, straight},
  };
}

}  // namespace lagroid::hard
