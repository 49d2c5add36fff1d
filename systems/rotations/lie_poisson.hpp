#pragma once
/// The discrete constrained Lie-Poisson equations of a GroupControl, momenta without arrows:
///
///     (dtau^{-1}_{-h xi})^* (dl(xi) + <lambda, dpsi(xi)>) = mu,    psi(xi) = 0,    mu' = Ad*_{tau(h xi)} mu.
///
/// The same step as that of the groupoid, in other unknowns: each checks the other.
///
///     const AttitudeControl system;
///     const auto step = lie_poisson_step(system, Vector<double, 3>(0.3, 0.2, 0.1));
///     if (step.converged()) std::cout << step.momentum.transpose() << '\n';
///
/// Requires a system with `control`. Status: `not_finite`, `not_converged`. [G] 6.1

#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/solvers/status.hpp>
#include <lagroid/systems/control/group_control.hpp>

#include <Eigen/LU>

namespace lagroid {

/// dl(xi) + <lambda, dpsi(xi)>, pulled back by dtau_{-h xi}: F- at the arrow tau(h xi).
template <class Sys, class T>
Vector<T, Sys::dimension> lie_poisson_momentum(const Sys& system, const Vector<T, Sys::dimension>& xi,
                                               const Vector<T, Sys::constraints>& lambda) {
  using G = typename Sys::GroupoidType;
  using D = Dual<T>;
  const auto augmented = [&](const Vector<D, Sys::dimension>& at) {
    D f = system.l(at);
    if constexpr (Sys::constraints > 0) f += system.psi(at).dot(lambda.template cast<D>());
    return f;
  };
  const Vector<T, Sys::dimension> differential = gradient_of(augmented, xi);
  return G::dretract_inverse(system.map, Vector<T, Sys::dimension>(xi * -system.h)).transpose() * differential;
}

/// One step of these equations.
template <class Sys> struct LiePoissonStep {
  SolveStatus status = SolveStatus::not_converged;
  Control<Sys::dimension, Sys::constraints> control;  ///< (xi, lambda)
  Vector<double, Sys::dimension> momentum;            ///< mu', after the step
  bool converged() const { return status == SolveStatus::converged; }
};

/// Solves
///
///     (dtau^{-1}_{-h xi})^* (dl(xi) + <lambda, dpsi(xi)>) = mu,    psi(xi) = 0
///
/// for (xi, lambda) by Newton's method from xi(mu), and returns mu' = Ad*_{tau(h xi)} mu. This is the step of a
/// GroupControl that has a `control`, in other unknowns: no arrow is differentiated, and none composed.
template <HasControl Sys>
LiePoissonStep<Sys> lie_poisson_step(const Sys& system, const Vector<double, Sys::dimension>& mu,
                                     int max_iterations = 50) {
  using G = typename Sys::GroupoidType;
  constexpr int n = Sys::dimension;
  constexpr int m = Sys::constraints;
  using D = Dual<double>;
  LiePoissonStep<Sys> out;
  out.control = system.control(mu);
  auto& [xi, lambda] = out.control;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    Vector<double, n + m> residual;
    Matrix<double, n + m, n + m> jacobian;
    for (int j = 0; j < n + m; ++j) {
      Vector<D, n> x = xi.template cast<D>();
      Vector<D, m> y = lambda.template cast<D>();
      (j < n ? x(j) : y(j - n)).derivative = 1;
      Vector<D, n + m> value;
      value.template head<n>() = lie_poisson_momentum<Sys, D>(system, x, y) - mu.template cast<D>();
      if constexpr (m > 0) value.template tail<m>() = system.psi(x);
      for (int i = 0; i < n + m; ++i) residual(i) = value(i).value;
      jacobian.col(j) = derivative_of(value);
    }
    const Vector<double, n + m> change = jacobian.partialPivLu().solve(residual);
    if (!change.allFinite()) {
      out.status = SolveStatus::not_finite;
      return out;
    }
    xi -= change.template head<n>();
    lambda -= change.template tail<m>();
    // Quadratic convergence: what is left is the square of the change.
    if (change.norm() <= 1e-9 * (xi.norm() + lambda.norm())) {
      out.status = SolveStatus::converged;
      break;
    }
  }
  out.momentum = G::adjoint(system.arrow(xi)).transpose() * mu;
  return out;
}

}  // namespace lagroid
