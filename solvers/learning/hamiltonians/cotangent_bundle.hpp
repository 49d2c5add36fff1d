#pragma once
/// R^2n, and T*Q in it, as spaces for integrators: R^2n acts by addition, and `project` returns to T*Q,
///
///     q <- q - G^T (G G^T)^{-1} g(q)  (Newton's step, twice),    p <- p - G^T (G G^T)^{-1} G p,    G = dg.
///
/// Methods for homogeneous spaces are the classical ones there. A step of order r leaves T*Q by O(h^{r + 1}); brought
/// back, it is of the same order (Hairer, Lubich, Wanner, *Geometric Numerical Integration*, IV.4). Two steps of Newton
/// are a formula, with derivatives in whatever its numbers depend on, where an iteration to a tolerance would be none;
/// they leave O(h^{4 r + 4}).
///
///     struct Circle {
///       template <class S> Vector<S, 1> constraint(const Vector<S, 2>& q) const {
///         return Vector<S, 1>(q.squaredNorm() - 1.0);
///       }
///     };
///     inline void return_to(const learning::CotangentBundle<Circle, 2>& space, Vector<double, 4>& z) {
///       space.project(z);
///     }
///
/// Requires dg of full rank near Q: elsewhere numbers are not finite. Nothing throws, and nothing allocates.

#include <lagroid/core/matrices/small_elimination.hpp>
#include <lagroid/core/scalars/dual.hpp>
#include <lagroid/solvers/learning/hamiltonians/parametric_hamiltonian.hpp>

#include <limits>
#include <string>
#include <utility>

namespace lagroid::learning {

/// R^2n, acting on itself by addition, in any scalar. N is n, or Eigen::Dynamic.
template <int N, class S = double> struct PhaseSpace {
  using Point = Vector<S, twice(N)>;
  using Algebra = Point;
  int coordinates = N;  ///< n

  Point zero_point() const { return Point::Zero(2 * coordinates); }
  Algebra zero_algebra() const { return zero_point(); }
  void act(const Algebra& u, Point& z) const { z += u; }
  void generator(const Algebra& u, const Point&, Point& v) const { v = u; }
  void bracket(const Algebra&, const Algebra&, Algebra& w) const { w.setZero(); }
  void project(Point&) const {}
  std::string name() const { return "R^" + std::to_string(2 * coordinates); }
};

/// G = dg at q, and what is orthogonal to Q there.
template <int M, int N, class S> struct NormalFrame {
  Matrix<S, M, N> g;

  /// (G G^T)^{-1} c.
  Vector<S, M> multipliers(Vector<S, M> c) const {
    Matrix<S, M, M> gram;
    for (int i = 0; i < M; ++i)
      for (int j = 0; j < M; ++j) {
        S sum(0.0);
        for (int n = 0; n < N; ++n) sum += g(i, n) * g(j, n);
        gram(i, j) = sum;
      }
    if (eliminate(gram, c) == 0) c.fill(S(std::numeric_limits<double>::quiet_NaN()));
    return c;
  }
  /// G v.
  template <class V> Vector<S, M> across(const V& v) const {
    Vector<S, M> out;
    for (int i = 0; i < M; ++i) {
      out(i) = S(0.0);
      for (int n = 0; n < N; ++n) out(i) += g(i, n) * v[n];
    }
    return out;
  }
  /// v <- v - G^T c.
  template <class V> void subtract(const Vector<S, M>& c, V& v) const {
    for (int i = 0; i < M; ++i)
      for (int n = 0; n < N; ++n) v[n] -= g(i, n) * c(i);
  }
};

/// T*Q = {g(q) = 0, G p = 0} in R^2n, g the constraint that a C writes (ParametricHamiltonian), in any scalar.
template <class C, int N, class S = double> struct CotangentBundle : PhaseSpace<N, S> {
  static constexpr int constraints = constraints_of<C, N>();
  static_assert(N != Eigen::Dynamic, "constraints are of a known number of coordinates");
  using Point = typename PhaseSpace<N, S>::Point;

  C constraint;

  explicit CotangentBundle(C of) : constraint(std::move(of)) {}

  void project(Point& z) const {
    S* q = z.data();
    S* p = q + N;
    for (int step = 0; step < 2; ++step) {
      Vector<S, constraints> off;
      const auto frame = frame_at(q, off);
      frame.subtract(frame.multipliers(off), q);
    }
    Vector<S, constraints> off;
    const auto frame = frame_at(q, off);
    frame.subtract(frame.multipliers(frame.across(p)), p);
  }
  std::string name() const { return "T*Q in " + PhaseSpace<N, S>::name(); }

 private:
  /// G, and the values of the constraint.
  NormalFrame<constraints, N, S> frame_at(const S* q, Vector<S, constraints>& value) const {
    NormalFrame<constraints, N, S> out;
    Vector<Dual<S>, N> x;
    for (int n = 0; n < N; ++n) x(n) = Dual<S>(q[n], S(0.0));
    for (int n = 0; n < N; ++n) {
      x(n).derivative = S(1.0);
      const Vector<Dual<S>, constraints> c = constraint.constraint(x);
      x(n).derivative = S(0.0);
      for (int i = 0; i < constraints; ++i) {
        out.g(i, n) = c(i).derivative;
        value(i) = c(i).value;
      }
    }
    return out;
  }
};

}  // namespace lagroid::learning
