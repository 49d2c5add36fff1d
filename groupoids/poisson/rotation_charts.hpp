#pragma once
/// Charts of symplectic groupoids of rotations in closed form: of so(3)*, pi(x) p = s x x p, of several of these, and
/// of its semidirect products with vectors that turn with the body,
///
///     x = (M, gamma_1, ..., gamma_K):    {M_i, M_j} = -eps_ijk M_k,  {M_i, gamma_j} = -eps_ijk gamma_k,
///     pi(x) p = (M x xi + sum_a gamma_a x v_a, gamma_a x xi),    p = (xi, v_1, ..., v_K):
///
/// se(3)* for K = 1; for K = 3, with the rows of an attitude as vectors, T*SO(3) is one of the leaves. With e^2 = 0,
/// (gamma + e M)' = (gamma + e M) x (xi + e v): one vector is so(3)* over dual numbers, and several add up, since an
/// arc is linear in x and in v.
///
///     const RotationChart<EulerTop> chart{EulerTop{}};
///     const auto arc = chart.from(Vector<double, 3>(0.8, 0.6, 1.1), Vector<double, 3>(0.1, 0, -0.2));
///
/// Two arcs each: RotationArcs, Karasev's, by the exponential, which fold at |xi| = 2 pi; CayleyArcs, rational, which
/// never do. Requires of a system `rotation_sign` s, or `turned_vectors` K. Nothing throws.
///
/// Source: as charts.hpp; Marsden, Ratiu, Weinstein, Semidirect products and reduction in mechanics, 1984.

#include <lagroid/core/poisson/poisson_system.hpp>
#include <lagroid/core/scalars/special_functions.hpp>
#include <lagroid/groupoids/groups/so3.hpp>

#include <string>
#include <utility>

namespace lagroid {

/// An arrow's middle, where its momentum is a covector, and its target.
template <class S, int N> struct ChartArc {
  Vector<S, N> middle;
  Vector<S, N> end;
  bool known = true;
};

/// Base of charts whose coordinate is the momentum itself.
template <class Sys> struct MomentumChart {
  static constexpr int size = Sys::dimension;
  Sys system;

  explicit MomentumChart(Sys of = {}) : system(std::move(of)) {}
  template <class S> Matrix<S, size, size> bivector(const Vector<S, size>& x) const { return system.bivector(x); }
  template <class S> Vector<S, size> momentum(const Vector<S, size>&, const Vector<S, size>& u) const { return u; }
  template <class S> Vector<S, size> coordinate(const Vector<S, size>&, const Vector<S, size>& p) const { return p; }
};

/// Arcs of pi(x) p = s x x p: beta = exp(-s p) x.
struct RotationArcs {
  template <class S> static ChartArc<S, 3> from(double s, const Vector<S, 3>& x, const Vector<S, 3>& p) {
    const Vector<S, 3> first = turned(s, p, x);
    const Vector<S, 3> second = turned(s, p, first);
    const S square = p(0) * p(0) + p(1) * p(1) + p(2) * p(2);
    const S c1 = stumpff<1>(square);
    const S c2 = stumpff<2>(square);
    const S c3 = stumpff<3>(square);
    ChartArc<S, 3> arc;
    for (int i = 0; i < 3; ++i) {
      arc.middle(i) = x(i) + c2 * first(i) + c3 * second(i);
      arc.end(i) = x(i) + c1 * first(i) + c2 * second(i);
    }
    return arc;
  }
  template <class S> static Vector<S, 3> product(double s, const Vector<S, 3>& u, const Vector<S, 3>& v) {
    const Matrix<S, 3, 3> turn = SO3::exp(Vector<S, 3>(v * S(-s))) * SO3::exp(Vector<S, 3>(u * S(-s)));
    return SO3::log(turn) * S(-s);
  }
  static std::string name() { return "by the exponential"; }

 private:
  /// -s p x y.
  template <class S> static Vector<S, 3> turned(double s, const Vector<S, 3>& p, const Vector<S, 3>& y) {
    Vector<S, 3> out;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const int k = (i + 2) % 3;
      out(i) = (p(k) * y(j) - p(j) * y(k)) * s;
    }
    return out;
  }
};

/// The same by Cayley's transform, a = s / 2: alpha = (I + a p^ + a^2 p p^T) middle, beta the same of -p. The
/// determinant of d alpha is (1 + |p|^2 / 4)^2.
struct CayleyArcs {
  template <class S> static ChartArc<S, 3> from(double s, const Vector<S, 3>& x, const Vector<S, 3>& p) {
    const double a = 0.5 * s;
    ChartArc<S, 3> arc;
    const S scale = 1.0 / (1.0 + (p(0) * p(0) + p(1) * p(1) + p(2) * p(2)) * (a * a));
    for (int i = 0; i < 3; ++i) arc.middle(i) = (x(i) - cross_entry(p, x, i) * a) * scale;
    const S along = (p(0) * arc.middle(0) + p(1) * arc.middle(1) + p(2) * arc.middle(2)) * (a * a);
    for (int i = 0; i < 3; ++i) arc.end(i) = arc.middle(i) - cross_entry(p, arc.middle, i) * a + p(i) * along;
    return arc;
  }
  template <class S> static Vector<S, 3> product(double s, const Vector<S, 3>& u, const Vector<S, 3>& v) {
    const double a = 0.5 * s;
    const S scale = 1.0 / (1.0 - (u(0) * v(0) + u(1) * v(1) + u(2) * v(2)) * (a * a));
    Vector<S, 3> out;
    for (int i = 0; i < 3; ++i) out(i) = (u(i) + v(i) - cross_entry(v, u, i) * a) * scale;
    return out;
  }
  static std::string name() { return "by Cayley's transform"; }

 private:
  template <class S> static S cross_entry(const Vector<S, 3>& p, const Vector<S, 3>& y, int i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    return p(j) * y(k) - p(k) * y(j);
  }
};

/// Of so(3)*, or of several of them beside each other.
template <class Sys, class Arcs> struct TurningChart : MomentumChart<Sys> {
  using Base = MomentumChart<Sys>;
  using Base::Base, Base::size;
  static_assert(size % 3 == 0);

  template <class S> ChartArc<S, size> from(const Vector<S, size>& x, const Vector<S, size>& p) const {
    ChartArc<S, size> arc;
    for (int a = 0; a < size; a += 3) {
      const ChartArc<S, 3> turned = Arcs::from(Sys::rotation_sign, three(x, a), three(p, a));
      for (int i = 0; i < 3; ++i) {
        arc.middle(a + i) = turned.middle(i);
        arc.end(a + i) = turned.end(i);
      }
    }
    return arc;
  }
  template <class S>
  Vector<S, size> product(const Vector<S, size>&, const Vector<S, size>& u, const Vector<S, size>& v) const {
    Vector<S, size> out;
    for (int a = 0; a < size; a += 3) {
      const Vector<S, 3> both = Arcs::product(Sys::rotation_sign, three(u, a), three(v, a));
      for (int i = 0; i < 3; ++i) out(a + i) = both(i);
    }
    return out;
  }
  static std::string name() {
    const std::string power = size == 3 ? "" : "^" + std::to_string(size / 3);
    return "symplectic groupoid of so(3)*" + power + ", " + Arcs::name();
  }

 private:
  template <class S> static Vector<S, 3> three(const Vector<S, size>& y, int a) {
    return Vector<S, 3>(y(a), y(a + 1), y(a + 2));
  }
};
template <class Sys> using RotationChart = TurningChart<Sys, RotationArcs>;
template <class Sys> using CayleyChart = TurningChart<Sys, CayleyArcs>;

/// Of the semidirect product with K = Sys::turned_vectors.
template <class Sys, class Arcs> struct SemidirectChart : MomentumChart<Sys> {
  using Base = MomentumChart<Sys>;
  using Base::Base, Base::size;
  static constexpr int vectors = Sys::turned_vectors;
  static_assert(size == 3 + 3 * vectors);

  template <class S> ChartArc<S, size> from(const Vector<S, size>& x, const Vector<S, size>& p) const {
    ChartArc<S, size> arc;
    for (int a = 1; a <= vectors; ++a) {
      Vector<Dual<S>, 3> point = paired(x, a, x);
      if (a > 1)
        for (int i = 0; i < 3; ++i) point(i).derivative = S(0.0);  // M is with the first
      const ChartArc<Dual<S>, 3> turned = Arcs::from(1.0, point, paired(p, 0, p, a));
      for (int i = 0; i < 3; ++i) {
        arc.middle(3 * a + i) = turned.middle(i).value;
        arc.end(3 * a + i) = turned.end(i).value;
        arc.middle(i) = a == 1 ? turned.middle(i).derivative : S(arc.middle(i) + turned.middle(i).derivative);
        arc.end(i) = a == 1 ? turned.end(i).derivative : S(arc.end(i) + turned.end(i).derivative);
      }
    }
    return arc;
  }
  template <class S>
  Vector<S, size> product(const Vector<S, size>&, const Vector<S, size>& u, const Vector<S, size>& v) const {
    Vector<S, size> out;
    for (int a = 1; a <= vectors; ++a) {
      const Vector<Dual<S>, 3> both = Arcs::product(1.0, paired(u, 0, u, a), paired(v, 0, v, a));
      for (int i = 0; i < 3; ++i) {
        out(i) = both(i).value;
        out(3 * a + i) = both(i).derivative;
      }
    }
    return out;
  }
  static std::string name() {
    return "symplectic groupoid of so(3) with " + std::to_string(vectors) + " turning vectors, " + Arcs::name();
  }

 private:
  /// Vector a of y, with e times vector b of z.
  template <class S>
  static Vector<Dual<S>, 3> paired(const Vector<S, size>& y, int a, const Vector<S, size>& z, int b = 0) {
    Vector<Dual<S>, 3> out;
    for (int i = 0; i < 3; ++i) out(i) = Dual<S>(y(3 * a + i), z(3 * b + i));
    return out;
  }
};

}  // namespace lagroid
