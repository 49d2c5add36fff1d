#pragma once
/// Rigid bodies by their momenta in the body's frame: Euler's top on so(3)*, a body in a fluid on se(3)*, and its
/// relatives on so(4)* and so(3, 1)*.
///
///     M' = M x Omega,    Omega = dH/dM,    {M_i, M_j} = -eps_ijk M_k
///
/// Their brackets are linear: those of reduced mechanical systems, so that both ways to integrate can be compared.
///
///     const EulerTop top;
///     const Vector<double, 3> rate = top.velocity(Vector<double, 3>(0.8, 0.6, 1.1));
///
/// Returns as PoissonSystem. Nothing throws.

#include <lagroid/core/parameter.hpp>
#include <lagroid/core/poisson/poisson_system.hpp>

#include <tuple>

namespace lagroid {

/// H = sum M_i^2 / 2 I_i; Casimir |M|^2 / 2.
struct EulerTop : PoissonSystem<EulerTop, 3> {
  Vector<double, 3> inertia{1, 2, 3};

  static auto parameters() {
    return std::tuple(parameter("inertia", &EulerTop::inertia, "kg m^2", "of the principal axes", positive));
  }
  static std::array<std::string, 3> labels() { return {"M1", "M2", "M3"}; }

  /// pi(M) p = s M x p with s = 1: its symplectic groupoid is that of SO(3).
  static constexpr double rotation_sign = 1;
  template <class S> Matrix<S, 3, 3> bivector(const Vector<S, 3>& m) const {
    return skew<S, 3>({{0, 1, -m(2)}, {0, 2, m(1)}, {1, 2, -m(0)}});
  }
  static constexpr int parts = 3;
  template <class S> S part(int i, const S& m) const { return m * m * (0.5 / varied<S>(inertia(i))); }
  template <class S> Vector<S, 1> casimirs(const Vector<S, 3>& m) const {
    return Vector<S, 1>((m(0) * m(0) + m(1) * m(1) + m(2) * m(2)) * 0.5);
  }

  /// Rotations about the axes: with equal strengths a noise that prefers none.
  static constexpr std::array<std::string_view, 3> noise_names{"M1", "M2", "M3"};
  template <class S> S noise(int k, const Vector<S, 3>& m) const { return m(k); }
};

/// M' = M x Omega + p x u, p' = p x Omega + kappa M x u with Omega = dH/dM, u = dH/dp and
///
///     H = sum A_i M_i^2 / 2 + B_i M_i p_i + C_i p_i^2 / 2.
///
/// kappa = 0: Kirchhoff's equations of a body in a fluid, on se(3)*; 1: a body on the sphere S^3, so(4)*; -1: in
/// hyperbolic space, so(3, 1)*. Casimirs: |p|^2 + kappa |M|^2 and M.p.
struct Kirchhoff : PoissonSystem<Kirchhoff, 6> {
  double kappa = 0;
  Vector<double, 3> a{1, 0.6, 0.4};
  Vector<double, 3> b{0.1, 0, -0.05};
  Vector<double, 3> c{0.5, 0.9, 0.7};

  static auto parameters() {
    return std::tuple(parameter("kappa", &Kirchhoff::kappa, "1", "curvature of space: 0 flat, 1 sphere, -1 hyperbolic"),
                      parameter("A", &Kirchhoff::a, "1/(kg m^2)", "of M_i^2 / 2 in the energy"),
                      parameter("B", &Kirchhoff::b, "1/(kg m)", "of M_i p_i in the energy"),
                      parameter("C", &Kirchhoff::c, "1/kg", "of p_i^2 / 2 in the energy"));
  }
  static std::array<std::string, 6> labels() { return {"M1", "M2", "M3", "p1", "p2", "p3"}; }

  static constexpr bool linear_bracket = true;
  template <class S> Matrix<S, 6, 6> bivector(const Vector<S, 6>& x) const {
    auto pi = skew<S, 6>({});
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const int k = (i + 2) % 3;
      set_skew<S>(pi, i, j, -x(k));
      set_skew<S>(pi, i, 3 + j, -x(3 + k));
      set_skew<S>(pi, 3 + i, j, -x(3 + k));
      set_skew<S>(pi, 3 + i, 3 + j, -x(k) * varied<S>(kappa));
    }
    return pi;
  }
  /// M_i, p_i and M_i + p_i, by which the products M_i p_i are squares.
  static constexpr int parts = 9;
  Vector<double, 6> form(int i) const {
    Vector<double, 6> l = Vector<double, 6>::Zero();
    if (i < 6) {
      l(i) = 1;
    } else {
      l(i - 6) = l(i - 3) = 1;
    }
    return l;
  }
  template <class S> S part(int i, const S& s) const {
    const int axis = i % 3;
    const auto along = varied<S>(b(axis));
    if (i >= 6) return s * s * (along * 0.5);
    return s * s * ((varied<S>(i < 3 ? a(axis) : c(axis)) - along) * 0.5);
  }
  template <class S> Vector<S, 2> casimirs(const Vector<S, 6>& x) const {
    S square(0.0);
    S product(0.0);
    for (int i = 0; i < 3; ++i) {
      square += x(3 + i) * x(3 + i) + x(i) * x(i) * varied<S>(kappa);
      product += x(i) * x(3 + i);
    }
    return Vector<S, 2>(square, product);
  }
};

}  // namespace lagroid
