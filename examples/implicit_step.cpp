// Implicit steps y = z exp(h g(y)) on a Lie group: Newton's iteration, steps of any size, integrators of order 1 to 3.
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/solvers/newton/crouch_grossman.hpp>
#include <lagroid/solvers/newton/lie_differentials.hpp>

#include <fmt/format.h>

#include <cmath>

using namespace lagroid;

int main() {
  // g : SO(3) -> so(3), written once; its derivative is automatic.
  const auto g = [](const auto& y) {
    using S = typename std::decay_t<decltype(y)>::Scalar;
    return Vector<S, 3>(y(0, 1) - 0.3, sin(y(1, 2)), y(2, 0) * y(0, 0));
  };
  const Matrix<double, 3, 3> z = SO3::exp(Vector<double, 3>(0.4, -0.2, 0.9));
  const GroupoidFibre<SO3> fibre(z);
  const AutomaticField field(fibre, g);

  // One step of the implicit Euler method. Version 1 moves y on the group, version 2 its logarithm v.
  LieNewtonOptions options;
  options.iteration = LieIteration::version1;
  const auto newton = lie_newton(ImplicitStep{fibre, field, /*h=*/0.5}, Vector<double, 3>::Zero(), options);
  fmt::print("h = 0.5: {} after {} iterations, |v - h g(y)| = {:.1e}\n", to_string(newton.status), newton.iterations,
             newton.residual);
  if (!newton.converged()) return 1;

  // A step of any size: plain Newton, and where that fails the path of solutions from h = 0.
  const auto far = solve_implicit_step(ImplicitStep{fibre, field, /*h=*/100.0});
  fmt::print("h = 100: {} with {} Jacobians, |v| = {:.2f}\n", to_string(far.status), far.factorisations, far.v.norm());
  if (!far.converged()) return 1;

  // y' = y g(y) by a method of order three. A step that does not converge advances nothing.
  LieIntegrator integrator(CrouchGrossman::dirk3(), fibre, field);
  for (int n = 0; n < 100; ++n)
    if (const auto report = integrator.advance(0.1); !report.converged()) return 1;
  const Vector<double, 3> turn = SO3::log(integrator.y());
  fmt::print("y(10) turns by {:.12f}\n", turn.norm());
  return 0;
}
