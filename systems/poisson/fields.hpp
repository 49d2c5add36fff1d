#pragma once
/// Brackets of fields and particles: the Maxwell-Bloch equations of a laser, Sklyanin's quadratic bracket of a spin
/// chain, and a charge in a magnetic field that varies.
///
///     const Sklyanin spins;
///     const auto pi = spins.bivector(Vector<double, 4>(0.7, 0.4, -0.5, 0.6));
///
/// Returns as PoissonSystem. Nothing throws.
///
/// Source: Sklyanin, Some algebraic structures connected with the Yang-Baxter equation, 1982; David and Holm, Multiple
/// Lie-Poisson structures and the Maxwell-Bloch equations, 1992.

#include <lagroid/core/parameter.hpp>
#include <lagroid/core/poisson/poisson_system.hpp>

#include <tuple>

namespace lagroid {

/// x' = y, y' = x z, z' = -x y: H = x^2 / 2 + z, Casimir (y^2 + z^2) / 2.
struct MaxwellBloch : PoissonSystem<MaxwellBloch, 3> {
  static std::array<std::string, 3> labels() { return {"x", "y", "z"}; }
  template <class S> Matrix<S, 3, 3> bivector(const Vector<S, 3>& x) const {
    return skew<S, 3>({{0, 1, -x(2)}, {0, 2, x(1)}});
  }
  static constexpr int parts = 3;
  template <class S> S part(int i, const S& x) const { return i == 0 ? S(x * x * 0.5) : i == 1 ? S(x * 0.0) : x; }
  template <class S> Vector<S, 1> casimirs(const Vector<S, 3>& x) const {
    return Vector<S, 1>((x(1) * x(1) + x(2) * x(2)) * 0.5);
  }
};

/// {f, g} = det(df, dg, dC_1, dC_2) with C_1 = (S_1^2 + S_2^2 + S_3^2) / 2 and C_2 = (S_0^2 + sum J_i S_i^2) / 2;
/// H = alpha_0 S_0 + alpha_1 S_1 + alpha_2 S_2^2 / 2.
struct Sklyanin : PoissonSystem<Sklyanin, 4> {
  Vector<double, 3> couplings{1, 2, 4};
  Vector<double, 3> alpha{1, 0.3, 0.5};

  static auto parameters() {
    return std::tuple(parameter("couplings", &Sklyanin::couplings, "1", "J_1, J_2, J_3 of the bracket"),
                      parameter("alpha", &Sklyanin::alpha, "1", "of S0, S1 and S2^2 / 2 in the energy"));
  }
  static std::array<std::string, 4> labels() { return {"S0", "S1", "S2", "S3"}; }

  template <class S> Matrix<S, 4, 4> bivector(const Vector<S, 4>& s) const {
    const auto& j = varied<S>(couplings);
    return skew<S, 4>({{0, 1, s(2) * s(3) * (j(2) - j(1))},
                       {0, 2, s(1) * s(3) * (j(0) - j(2))},
                       {0, 3, s(1) * s(2) * (j(1) - j(0))},
                       {1, 2, s(0) * s(3) * -1.0},
                       {1, 3, s(0) * s(2)},
                       {2, 3, s(0) * s(1) * -1.0}});
  }
  static constexpr int parts = 3;
  template <class S> S part(int i, const S& s) const {
    return i == 2 ? S(s * s * (varied<S>(alpha(2)) * 0.5)) : S(s * varied<S>(alpha(i)));
  }
  template <class S> Vector<S, 2> casimirs(const Vector<S, 4>& s) const {
    S first(0.0);
    S second = s(0) * s(0);
    for (int i = 0; i < 3; ++i) {
      first += s(i + 1) * s(i + 1);
      second += s(i + 1) * s(i + 1) * varied<S>(couplings(i));
    }
    return Vector<S, 2>(first * 0.5, second * 0.5);
  }
};

/// x'' = x' x B(x) - k x with B = (x2, x3, 1 + x1), which has no divergence: {x_i, v_j} = delta_ij, {v_i, v_j} =
/// eps_ijk B_k(x), H = |v|^2 / 2 + k |x|^2 / 2.
struct MagneticParticle : PoissonSystem<MagneticParticle, 6> {
  double stiffness = 1;

  static auto parameters() {
    return std::tuple(parameter("stiffness", &MagneticParticle::stiffness, "1/s^2", "k of the trap", nonnegative));
  }
  static std::array<std::string, 6> labels() { return {"x1", "x2", "x3", "v1", "v2", "v3"}; }

  template <class S> Matrix<S, 6, 6> bivector(const Vector<S, 6>& x) const {
    return skew<S, 6>(
        {{0, 3, S(1.0)}, {1, 4, S(1.0)}, {2, 5, S(1.0)}, {3, 4, x(0) + 1.0}, {3, 5, -x(2)}, {4, 5, x(1)}});
  }
  static constexpr int parts = 6;
  template <class S> S part(int i, const S& s) const {
    return i < 3 ? S(s * s * (varied<S>(stiffness) * 0.5)) : S(s * s * 0.5);
  }

  /// Positions, whose fields are forces.
  static constexpr std::array<std::string_view, 3> noise_names{"x1", "x2", "x3"};
  template <class S> S noise(int k, const Vector<S, 6>& x) const { return x(k); }
};

}  // namespace lagroid
