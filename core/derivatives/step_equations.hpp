#pragma once
/// The equations of one step, F-(g, lambda) = mu, phi(g) = 0, C(beta(g)) = 0, their matrix, and its condition.
///
/// Every solver of steps has these equations and this matrix; where the matrix is regular, the step depends smoothly on
/// the state.
///
///     const auto d = two_sided(system, step.arrow, step.multipliers);
///     const auto residual = StepEquations<Sys>::residual(d, momentum);  // zero at a step from (alpha(g), momentum)
///     const double condition = regularity_condition(system, step);     // infinite where the system is not regular
///
/// Nothing throws.
///
/// Source: [G] Def. 3.3, Def. 3.5, Corollary 3.4.

#include <lagroid/core/derivatives/two_sided.hpp>
#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/core/matrices/scaling.hpp>

namespace lagroid {

/// The step equations F-(g, lambda) = mu, phi(g) = 0, C(beta(g)) = 0, in the unknowns (w, lambda), g <- g tau(w).
///
/// Written entry by entry: every file with a system of its own compiles them for its sizes, and Eigen's expressions of
/// blocks would take most of that time (docs/decisions/72_expressions_cost_their_square.md).
///
/// For object constraints F- contains lambda . dC o rho at the source, the impulse between two arrows.
template <class Sys, class S = double> struct StepEquations {
  static constexpr int n = Sys::dimension;
  static constexpr int m = Sys::constraints;
  static constexpr int size = n + m;
  /// Not aligned, so that Eigen reads it number by number, as it is written.
  using Residual = Eigen::Matrix<S, size, 1, Eigen::DontAlign>;
  using Jacobian = Matrix<S, size, size>;

  static Residual residual(const GradientsOf<Sys, S>& d,
                           const AlgebroidVector<typename Sys::GroupoidType, S>& momentum) {
    Residual r;
    unrolled<n>([&]<int I>() { r(I) = -d.source_gradient(I) - momentum(I); });
    unrolled<m>([&]<int A>() { r(n + A) = d.constraint(A); });
    return r;
  }

  /// [ -d2f/dv dw   -(d(phi, C o alpha)/dv)^T ;  d(phi, C o beta)/dw   0 ].
  static Jacobian jacobian(const TwoSidedOf<Sys>& d) {
    Jacobian j;
    for (int k = 0; k < n; ++k) {
      for (int i = 0; i < n; ++i) j(i, k) = -d.mixed(i, k);
      for (int a = 0; a < m; ++a) j(n + a, k) = d.constraint_target(a, k);
    }
    for (int b = 0; b < m; ++b) {
      for (int i = 0; i < n; ++i) j(i, n + b) = -d.constraint_source(i, b);
      for (int a = 0; a < m; ++a) j(n + a, n + b) = 0;
    }
    return j;
  }
};

/// The condition number of the equilibrated matrix of T F- at a point of Sigma_L; infinite where the system is not
/// regular ([G] Def. 3.5). For arrow constraints the matrix of T F+ is its transpose
/// up to signs, so that one number serves both, which is Corollary 3.4 of [G].
template <DiscreteSystem Sys> double regularity_condition(const Sys& system, const Step<Sys>& step) {
  using E = StepEquations<Sys>;
  const auto j = E::jacobian(two_sided(system, step.arrow, step.multipliers));
  const typename E::Jacobian scaled = Scaling<E::size>::equilibrate(j).apply(j);
  const Eigen::VectorXd sigma = singular_values(scaled);
  return sigma(0) / sigma(E::size - 1);
}

}  // namespace lagroid
