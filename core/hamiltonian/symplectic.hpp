#pragma once
/// The symplectic form of T*G in canonical coordinates, and the Poisson structure of A*G: {q^a, mu_i} = rho(e_i)^a,
/// {mu_i, mu_j} = -<mu, [e_i, e_j]>.
///
/// Momenta of a rigid body or a rolling ball do not commute; this tensor is the structure that a step of a discrete
/// Lagrangian system keeps.
///
///     const auto pi = poisson_tensor(groupoid, q, mu);
///     const DualPoint<Vector<double, 0>, double, 3> z{q, mu};
///     const double rate = PoissonAlgebra<SO3>(groupoid).bracket(z, first, second);  // {first, second} at z
///
/// Requires functions that take a DualPoint over any scalar to that scalar. Returns values over the scalar of the
/// point. Nothing throws.
///
/// Source: [G] 2.1.

#include <lagroid/core/algebroid.hpp>
#include <lagroid/core/cotangent.hpp>
#include <lagroid/core/derivatives/directional.hpp>

namespace lagroid {

/// The derivative at x of f, a map of R^N over any scalar to vectors, column by column. (One scalar type for maps of
/// all sizes, and a matrix of dynamic size, spare the compiler.)
template <int N, class F> Eigen::MatrixXd jacobian(const Vector<double, N>& x, const F& f) {
  Eigen::MatrixXd out;
  for (int i = 0; i < N; ++i) {
    const auto column = derivative_along(f, x, unit_vector<double, N>(i));
    if (i == 0) out.resize(column.size(), N);
    out.col(i) = column;
  }
  return out;
}

/// The matrix of a canonical form: {x^a, P_a} = 1. Pi = [0 I; -I 0]; omega = dx ^ dP has the same entries.
template <int Half> Matrix<double, 2 * Half, 2 * Half> canonical_tensor() {
  Matrix<double, 2 * Half, 2 * Half> j = Matrix<double, 2 * Half, 2 * Half>::Zero();
  j.template topRightCorner<Half, Half>().setIdentity();
  j.template bottomLeftCorner<Half, Half>() = -Matrix<double, Half, Half>::Identity();
  return j;
}

/// Canonical coordinates of T*G around a fixed arrow g0: of an arrow, (w, u) -> b(alpha(g0) + u) tau(w) with b the
/// bisection through g0; of a covector, its values P on the coordinate directions.
template <Groupoid G> class CotangentChart {
 public:
  static constexpr int n = G::dimension;
  static constexpr int d = object_dimension_of<G>();
  static constexpr int size = n + d;

  /// Refers to the cotangent groupoid.
  CotangentChart(CotangentGroupoid<G>&&, const ArrowOf<G>&) = delete;
  CotangentChart(const CotangentGroupoid<G>& cotangent, const ArrowOf<G>& centre)
      : cotangent_(cotangent), centre_(centre) {}

  /// The arrow at x = (w, u).
  template <class S> auto arrow(const Vector<S, size>& x) const {
    const G& groupoid = cotangent_.groupoid;
    const auto g0 = groupoid.template cast<S>(centre_);
    const auto from = groupoid.displace_object(groupoid.source(g0), Vector<S, d>(x.template tail<d>()));
    const auto g = groupoid.bisection(g0, from);
    return groupoid.multiply(g, groupoid.tau(groupoid.target(g), Vector<S, n>(x.template head<n>())));
  }

  /// The covector that has the arrow at x and the values `values` on the basis there (TangentBasis): coordinates of T*G
  /// too, but not canonical.
  template <class S> auto covector(const Vector<S, size>& x, const Vector<S, size>& values) const {
    return typename CotangentGroupoid<G>::template Arrow<S>{arrow<S>(x), values};
  }

  /// (x, P) of a covector.
  template <class A, class S> Vector<S, 2 * size> canonical(const Covector<A, S, size>& p) const {
    using D = Dual<S>;
    const G& groupoid = cotangent_.groupoid;
    const auto g0 = groupoid.template cast<S>(centre_);
    const auto from = groupoid.source(p.arrow);
    Vector<S, size> x;
    x << groupoid.tau_inverse(groupoid.multiply(groupoid.inverse(groupoid.bisection(g0, from)), p.arrow)),
        groupoid.object_displacement(groupoid.source(g0), from);
    Vector<S, 2 * size> out;
    out.template head<size>() = x;
    for (int a = 0; a < size; ++a) out(size + a) = cotangent_.on(p, arrow<D>(moved_along(x, unit_vector<S, size>(a))));
    return out;
  }

 private:
  const CotangentGroupoid<G>& cotangent_;
  ArrowOf<G> centre_;
};

/// The Poisson tensor of A*G at (q, mu), in object coordinates followed by momenta: {q^a, q^b} = 0,
/// {q^a, mu_i} = rho(e_i)^a, {mu_i, mu_j} = -<mu, [e_i, e_j]>. It makes the target of T*G a Poisson map ([G] 2.1).
template <Groupoid G, class Q, class S>
auto poisson_tensor(const G& groupoid, const Q& q, const Vector<S, G::dimension>& mu) {
  constexpr int n = G::dimension;
  constexpr int k = G::object_coordinate_count();
  const LieAlgebroid<G> algebroid(groupoid);
  const auto structure = algebroid.structure_functions(q);
  Matrix<S, k + n, k + n> pi = Matrix<S, k + n, k + n>::Constant(S(0.0));
  for (int i = 0; i < n; ++i) {
    const auto rho = algebroid.anchor(q, Vector<S, n>(Vector<S, n>::Unit(i)));
    for (int a = 0; a < k; ++a) {
      pi(a, k + i) = rho(a);
      pi(k + i, a) = -rho(a);
    }
    for (int j = 0; j < n; ++j)
      for (int l = 0; l < n; ++l) pi(k + i, k + j) -= mu(l) * structure[std::size_t(l)](i, j);
  }
  return pi;
}

/// Functions on A*G take a point (q, mu) over any scalar, `DualPoint`, to that scalar. Their Poisson bracket at z:
/// {f, h} = df.Pi.dh, with f and h differentiated along the anchors and the momenta only, which is all that Pi needs.
template <Groupoid G> class PoissonAlgebra {
 public:
  static constexpr int n = G::dimension;
  template <class S> using Point = DualPoint<typename G::template Object<S>, S, n>;

  /// Refers to the groupoid.
  explicit PoissonAlgebra(const G& groupoid) : groupoid_(groupoid) {}
  explicit PoissonAlgebra(G&&) = delete;

  template <class Q, class S, class F, class H> S bracket(const DualPoint<Q, S, n>& z, const F& f, const H& h) const {
    const auto [f_along, f_momentum] = gradients(z, f);
    const auto [h_along, h_momentum] = gradients(z, h);
    const auto structure = LieAlgebroid<G>(groupoid_).structure_functions(z.object);
    S sum(0.0);
    for (int i = 0; i < n; ++i) {
      sum += f_along(i) * h_momentum(i) - f_momentum(i) * h_along(i);
      for (int j = 0; j < n; ++j)
        for (int l = 0; l < n; ++l)
          sum -= f_momentum(i) * h_momentum(j) * z.momentum(l) * structure[std::size_t(l)](i, j);
    }
    return sum;
  }

 private:
  /// (rho(e_i)[f])_i at constant mu, and df/dmu.
  template <class Q, class S, class F> auto gradients(const DualPoint<Q, S, n>& z, const F& f) const {
    using D = Dual<S>;
    const auto q = groupoid_.template cast_object<D>(z.object);
    const Vector<D, n> mu = z.momentum.template cast<D>();
    const auto along = [&](const Vector<D, n>& u) { return f(Point<D>{groupoid_.target(groupoid_.tau(q, u)), mu}); };
    const auto by_momentum = [&](const Vector<D, n>& moved) { return f(Point<D>{q, moved}); };
    return std::pair(gradient_of(along, Vector<S, n>(Vector<S, n>::Constant(S(0.0)))),
                     gradient_of(by_momentum, z.momentum));
  }

  const G& groupoid_;
};

}  // namespace lagroid
