#pragma once
/// Rigid bodies by their momentum and by directions of space seen from the body: the heavy top on se(3)*, and a body
/// with its attitude on T*SO(3).
///
///     M' = M x Omega + gamma x w,    gamma' = gamma x Omega,    Omega = I^{-1} M,    H = sum M_i^2 / 2 I_i + <w,
///     gamma>
///
/// w is the weight times the vector from the fixed point to the centre of mass, gamma the upward vertical in the body.
/// Noise may drive both by any of their coordinates: along M_i it turns the body about its axis i, along gamma_i it is
/// a torque.
///
///     const HeavyTopBracket top;
///     const Vector<double, 6> rate = top.velocity(Vector<double, 6>(0, 0.1, 2, 0, 0.6, 0.8));
///
/// Returns as PoissonSystem. Nothing throws.
///
/// Source: Marsden, Ratiu, Weinstein, Semidirect products and reduction in mechanics, 1984.

#include <lagroid/core/parameter.hpp>
#include <lagroid/core/poisson/poisson_system.hpp>

#include <tuple>

namespace lagroid {

namespace detail {

/// K directions; the vertical is the last.
template <class Derived, int K> struct TopBracket : PoissonSystem<Derived, 3 + 3 * K> {
  static constexpr int n = 3 + 3 * K;
  Vector<double, 3> inertia{1, 1, 0.5};
  Vector<double, 3> weight{0, 0, 1};

  static auto parameters() {
    return std::tuple(parameter("inertia", &Derived::inertia, "kg m^2", "of the principal axes", positive),
                      parameter("weight", &Derived::weight, "N m", "weight times the vector to the centre of mass"));
  }

  /// Its symplectic groupoid is that of SO(3) and K vectors that it turns (groupoids/poisson/rotation_charts.hpp).
  static constexpr int turned_vectors = K;
  template <class S> Matrix<S, n, n> bivector(const Vector<S, n>& x) const {
    auto pi = skew<S, n>({});
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const int k = (i + 2) % 3;
      set_skew<S>(pi, i, j, -x(k));
      for (int a = 3; a < n; a += 3) {
        set_skew<S>(pi, i, a + j, -x(a + k));
        set_skew<S>(pi, i, a + k, x(a + j));
      }
    }
    return pi;
  }

  /// The axes' kinetic energies, and the vertical's components.
  static constexpr int parts = 6;
  Vector<double, n> form(int i) const { return Vector<double, n>::Unit(i < 3 ? i : n - 6 + i); }
  template <class S> S part(int i, const S& s) const {
    return i < 3 ? S(s * s * (0.5 / varied<S>(inertia(i)))) : S(s * varied<S>(weight(i - 3)));
  }

  template <class S> S noise(int k, const Vector<S, n>& x) const { return x(k); }

 protected:
  /// gamma_a . y, y the momentum (b = 0) or another direction.
  template <class S> static S product(const Vector<S, n>& x, int a, int b) {
    S sum = x(3 * a) * x(3 * b);
    for (int i = 1; i < 3; ++i) sum += x(3 * a + i) * x(3 * b + i);
    return sum;
  }
};

}  // namespace detail

/// x = (M, gamma) on se(3)*. Casimirs: |gamma|^2 and M . gamma.
struct HeavyTopBracket : detail::TopBracket<HeavyTopBracket, 1> {
  static std::array<std::string, 6> labels() { return {"M1", "M2", "M3", "g1", "g2", "g3"}; }
  template <class S> Vector<S, 2> casimirs(const Vector<S, 6>& x) const {
    return Vector<S, 2>(product(x, 1, 1), product(x, 0, 1));
  }
  static constexpr std::array<std::string_view, 6> noise_names{"M1", "M2", "M3", "g1", "g2", "g3"};
};

/// x = (M, R11, R12, ..., R33), R the attitude, whose rows are space's axes seen from the body, the third the vertical:
/// T*SO(3) is where R is a rotation. Casimirs: the entries of R R^T.
struct BodyInSpace : detail::TopBracket<BodyInSpace, 3> {
  BodyInSpace() { weight.setZero(); }
  static std::array<std::string, 12> labels() {
    return {"M1", "M2", "M3", "R11", "R12", "R13", "R21", "R22", "R23", "R31", "R32", "R33"};
  }
  /// Its attitude must be a rotation.
  std::string refusal(const Vector<double, 12>& x) const {
    const Matrix<double, 3, 3> rows = Eigen::Map<const Matrix<double, 3, 3>>(x.data() + 3);
    const double off = (rows.transpose() * rows - Matrix<double, 3, 3>::Identity()).cwiseAbs().maxCoeff();
    if (off <= 1e-9 && rows.determinant() > 0) return {};
    return "has no rotation after the momentum: the rows R11 to R33 are orthonormal, and det R = 1";
  }
  template <class S> Vector<S, 6> casimirs(const Vector<S, 12>& x) const {
    Vector<S, 6> all;
    for (int a = 0; a < 3; ++a) {
      all(a) = product(x, a + 1, a + 1);
      all(3 + a) = product(x, a + 1, (a + 1) % 3 + 1);
    }
    return all;
  }
  static constexpr std::array<std::string_view, 12> noise_names{"M1",  "M2",  "M3",  "R11", "R12", "R13",
                                                                "R21", "R22", "R23", "R31", "R32", "R33"};
};

}  // namespace lagroid
