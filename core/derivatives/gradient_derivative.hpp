#pragma once
/// The derivative of the gradient df/du of f = L + <lambda, phi> at one end of an arrow along displacements v of the
/// same end, for f(g tau(v) tau(u)) or f(tau(u)^{-1} tau(v)^{-1} g).
///
/// It is the exact derivative of F+ or -F- along the fibre at any arrow, which Newton's method needs; the symmetric
/// `one_sided_hessian` differs from it by a bracket term where the gradient is not zero.
///
///     const auto a = gradient_derivative(system, g, lambda, End::target);  // a(i, j) = d/dv_j (df/du_i), n x n
///
/// Discrete forces and nonholonomic reactions are not in f. Nothing throws.

#include <lagroid/core/derivatives/two_sided.hpp>

namespace lagroid {

/// d/dv_j of the gradient df/du_i of f = L + <lambda, phi> when the arrow is first displaced by v, then by u, both at
/// the same end: f(g tau(v) tau(u)) or f(tau(u)^{-1} tau(v)^{-1} g). The symmetric Hessian of `one_sided_hessian` plus
/// half the gradient on the bracket [v, u].
template <DiscreteSystem Sys>
Matrix<double, Sys::dimension, Sys::dimension> gradient_derivative(const Sys& system,
                                                                   const ArrowOf<typename Sys::GroupoidType>& g,
                                                                   const typename Sys::Multipliers& lambda, End end) {
  if constexpr (requires { system.gradient_derivative(g, lambda, end); }) {
    return system.gradient_derivative(g, lambda, end);
  } else {
    using M = HyperDualOf<Sys>;
    constexpr int n = Sys::dimension;
    const auto& groupoid = system.groupoid;
    Vector<M, n> u = Vector<M, n>::Constant(M(0));
    Vector<M, n> v = u;
    for (int i = 0; i < n; ++i) {
      u(i).set_left(i, 1);
      v(i).set_right(i, 1);
    }
    const Vector<M, n> zero = Vector<M, n>::Constant(M(0));
    const auto start = groupoid.template cast<M>(g);
    const auto once = end == End::target ? groupoid.translate(zero, start, v) : groupoid.translate(v, start, zero);
    const auto twice = end == End::target ? groupoid.translate(zero, once, u) : groupoid.translate(u, once, zero);
    return detail::augmented_lagrangian<M>(system, twice, lambda).mixed();
  }
}

}  // namespace lagroid
