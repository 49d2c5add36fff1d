#pragma once
/// Poisson systems whose bracket is that of logarithms, {x_i, x_j} = c_ij x_i x_j with constant c: populations.
///
/// In ln x the bracket is constant, so that its symplectic groupoid is known in closed form and no step leaves x > 0.
///
///     struct Two : LogCanonicalSystem<Two, 2> {
///       Matrix<double, 2, 2> log_coefficients() const { return skew<double, 2>({{0, 1, 1.0}}); }
///       template <class S> S hamiltonian(const Vector<S, 2>& x) const { return log(x(0) * x(1)) - x(0) - x(1); }
///     };
///
/// Requires an antisymmetric c, that of a template on the scalar where it depends on parameters; any is a Poisson
/// bracket. Returns as PoissonSystem. Nothing throws.

#include <lagroid/core/poisson/poisson_system.hpp>

namespace lagroid {

template <class Derived, int N> struct LogCanonicalSystem : PoissonSystem<Derived, N> {
  template <class S> Matrix<S, N, N> bivector(const Vector<S, N>& x) const {
    const auto c = log_coefficients_of<S>(static_cast<const Derived&>(*this));
    Matrix<S, N, N> pi;
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) pi(i, j) = x(i) * x(j) * c(i, j);
    return pi;
  }
  bool contains(const Vector<double, N>& x) const { return (x.array() > 0).all(); }
};

}  // namespace lagroid
