#pragma once
/// Hamiltonian dynamics on T*Q for Q = { C(q) = 0 } by projection instead of multipliers: q' = P dH/dp, p' = -P^T dH/dq
/// + W dH/dp.
///
/// The constrained motion becomes an explicit vector field, which any integrator of vector fields takes.
///
///     struct Pendulum : ProjectedHamiltonian<Pendulum, 2, 1> {
///       template <class S> Vector<S, 1> constraint(const Vector<S, 2>& q) const {
///         return Vector<S, 1>(q.squaredNorm() - 1.0);
///       }
///       template <class S> S hamiltonian(const Vector<S, 2>& q, const Vector<S, 2>& p) const {
///         return p.squaredNorm() * 0.5 + q(1);
///       }
///     };
///     const auto rates = Pendulum{}.rates(q, p);  // rates.q, rates.p
///
/// Requires that dC has full rank and, for the field to stay on T*Q, that C(q) = 0 and dC p = 0. Returns derivatives
/// exact to round-off; they are not finite where dC loses rank. Nothing throws.
///
/// Source: [H] (chameq), (wmatr).

#include <lagroid/core/scalars/dual.hpp>
#include <lagroid/core/scalars/jet.hpp>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <utility>

namespace lagroid {

/// Base of a Hamiltonian system on T*Q, Q = {q in R^N : C(q) = 0}, C with values in R^M and G = dC of full rank on Q.
///
/// The derived class **must** write, in any scalar S,
///
///     template <class S> Vector<S, M> constraint(const Vector<S, N>& q) const
///
/// and its energy, either whole or as p^T M(q)^{-1} p / 2 + V(q):
///
///     template <class S> S hamiltonian(const Vector<S, N>& q, const Vector<S, N>& p) const
///     template <class S> Matrix<S, N, N> mass_matrix(const Vector<S, N>& q) const     and
///     template <class S> S potential(const Vector<S, N>& q) const
///
/// (M symmetric and positive definite). Deduced is ([H] (chameq), (wmatr)), exactly:
///
///     P = I - G^T (G G^T)^{-1} G,   Lambda = d(P^T p)/dq,   W = P^T Lambda^T P + Lambda P - P^T Lambda^T,
///     q' = P dH/dp,   p' = -P^T dH/dq + W dH/dp,
///
/// which leaves T*Q = {C = 0, G p = 0} invariant. ([H] writes P with the transpose of this G.) As z = (q, p)
/// it is a field for LieGroupStep on EuclideanSpace<2 N>.
template <class Derived, int N, int M> class ProjectedHamiltonian {
 public:
  static constexpr int dimension = N;
  static constexpr int constraints = M;
  using V = Vector<double, N>;
  using Square = Matrix<double, N, N>;

  struct Rates {
    V q, p;
  };

  /// G(q), M x N.
  Matrix<double, M, N> constraint_jacobian(const V& q) const {
    const Vector<Jet<double, N>, M> c = self().constraint(variables(q));
    Matrix<double, M, N> g;
    for (int i = 0; i < M; ++i) g.row(i) = c(i).gradient().transpose();
    return g;
  }
  /// P(q).
  Square projection(const V& q) const { return Frame(constraint_jacobian(q)).p; }
  /// Lambda(q, p) = d(P(q)^T p) / dq.
  Square lambda(const V& q, const V& p) const { return lambda(Frame(constraint_jacobian(q)), q, p); }
  /// W(q, p).
  Square w(const V& q, const V& p) const {
    const Frame frame(constraint_jacobian(q));
    return w(frame.p, lambda(frame, q, p));
  }
  /// (dH/dq, dH/dp).
  Rates gradient(const V& q, const V& p) const {
    if constexpr (requires { self().mass_matrix(q); }) {
      const V velocity = Eigen::LLT<Square>(self().mass_matrix(q)).solve(p);
      const auto x = variables(q);
      const Matrix<Jet<double, N>, N, N> mass = self().mass_matrix(x);
      Jet<double, N> energy = self().potential(x);
      for (int i = 0; i < N; ++i)
        for (int j = 0; j < N; ++j) energy -= mass(i, j) * (0.5 * velocity(i) * velocity(j));
      return {energy.gradient(), velocity};
    } else {
      using J = Jet<double, 2 * N>;
      Vector<J, N> x, y;
      for (int i = 0; i < N; ++i) {
        x(i) = J::variable(q(i), i);
        y(i) = J::variable(p(i), N + i);
      }
      const Vector<double, 2 * N> both = self().hamiltonian(x, y).gradient();
      return {both.template head<N>(), both.template tail<N>()};
    }
  }
  double energy(const V& q, const V& p) const {
    if constexpr (requires { self().mass_matrix(q); }) {
      return 0.5 * p.dot(Eigen::LLT<Square>(self().mass_matrix(q)).solve(p)) + self().potential(q);
    } else {
      return self().hamiltonian(q, p);
    }
  }
  /// (q', p').
  Rates rates(const V& q, const V& p) const {
    const Frame frame(constraint_jacobian(q));
    const Rates slope = gradient(q, p);
    return {frame.p * slope.p, -(frame.p * slope.q) + w(frame.p, lambda(frame, q, p)) * slope.p};
  }
  void operator()(double, const Vector<double, 2 * N>& z, Vector<double, 2 * N>& out) const {
    const Rates r = rates(z.template head<N>(), z.template tail<N>());
    out << r.q, r.p;
  }

 private:
  /// G^+ = G^T (G G^T)^{-1} and P = I - G^+ G.
  struct Frame {
    Matrix<double, N, M> inverse;
    Square p;
    explicit Frame(const Matrix<double, M, N>& g)
        : inverse(g.transpose() * Matrix<double, M, M>(g * g.transpose()).inverse()),
          p(Square::Identity() - inverse * g) {}
  };

  const Derived& self() const { return static_cast<const Derived&>(*this); }
  static Vector<Jet<double, N>, N> variables(const V& q) {
    Vector<Jet<double, N>, N> x;
    for (int i = 0; i < N; ++i) x(i) = Jet<double, N>::variable(q(i), i);
    return x;
  }
  static Square w(const Square& p, const Square& lambda) {
    return p * lambda.transpose() * p + lambda * p - p * lambda.transpose();
  }
  /// dP = -(A + A^T) with A = G^+ dG P, of which column j takes dG along the j-th coordinate.
  Square lambda(const Frame& frame, const V& q, const V& momentum) const {
    using J = Jet<double, N>;
    using D = Dual<J>;
    Square out;
    for (int j = 0; j < N; ++j) {
      Vector<D, N> x;
      for (int i = 0; i < N; ++i) x(i) = D(J::variable(q(i), i), J(i == j ? 1.0 : 0.0));
      const Vector<D, M> c = self().constraint(x);
      Matrix<double, M, N> dg;
      for (int i = 0; i < M; ++i) dg.row(i) = c(i).derivative.gradient().transpose();
      const Square a = frame.inverse * dg * frame.p;
      out.col(j) = -(a * momentum) - a.transpose() * momentum;
    }
    return out;
  }
};

}  // namespace lagroid
