#pragma once
/// Polynomial curves on [0, 1] and the quadrature of functions of them: a curve of degree s is given by its values at
/// s + 1 nodes, those of Lobatto, and its points are those of a quadrature,
///
///     x(c_i) = sum_j value[i][j] x_j,    x'(c_i) = sum_j derivative[i][j] x_j,    int f = sum_i b_i f(x(c_i),
///     x'(c_i)).
///
/// Galerkin Lagrangians are made of it.
///
///     const auto& rule = CurveRule<2, CurveQuadrature::gauss>::rule();
///     const double length = rule.weight[0] + rule.weight[1];  // 1
///
/// Requires a degree of at least one, and two of `lobatto_pair`. Gauss's s points are exact for degree 2 s - 1, and so
/// are Lobatto's s + 1, the ends among them. Nothing throws.
///
/// Source: Hairer, Lubich, Wanner, *Geometric Numerical Integration*, 2006, II.1; Abramowitz and Stegun, 25.4.32.

#include <lagroid/core/poisson/gauss_collocation.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace lagroid {

/// The points at which a curve of degree s is looked at: the s of Gauss, the s + 1 of Lobatto, or s of Lobatto, which
/// make the curve that of the pair Lobatto IIIA-IIIB.
enum class CurveQuadrature { gauss, lobatto, lobatto_pair };

/// Lobatto's nodes of degree s: the s + 1 points of [0, 1] where P_s' vanishes, and the ends, with their weights.
template <int Degree> struct LobattoNodes {
  static_assert(Degree >= 1);
  std::array<double, std::size_t(Degree + 1)> node;
  std::array<double, std::size_t(Degree + 1)> weight;

  LobattoNodes() {
    for (int i = 0; i <= Degree; ++i) {
      long double z = i == Degree ? 1 : -std::cos(std::numbers::pi_v<long double> * i / Degree);
      for (int pass = 0; pass < 20 && i > 0 && i < Degree; ++pass) {
        const auto [p, slope] = legendre(z);
        z -= slope * (1 - z * z) / (2 * z * slope - Degree * (Degree + 1) * p);  // P'' by Legendre's equation
      }
      const long double p = legendre(z)[0];
      node[std::size_t(i)] = double((1 + z) / 2);
      weight[std::size_t(i)] = double(1 / (Degree * (Degree + 1) * p * p));
    }
  }

 private:
  /// P_s(z) and P_s'(z), -1 < z < 1; at the ends P_s alone.
  static std::array<long double, 2> legendre(long double z) {
    long double before = 1, p = z;
    for (int m = 1; m < Degree; ++m) {
      const long double next = ((2 * m + 1) * z * p - m * before) / (m + 1);
      before = std::exchange(p, next);
    }
    return {p, Degree * (before - z * p) / (1 - z * z)};
  }
};

/// The points and weights of a quadrature, and there the values and derivatives of the polynomials of degree s that
/// are one at one of Lobatto's nodes and zero at the others.
template <int Degree, CurveQuadrature Kind = CurveQuadrature::lobatto> struct CurveRule {
  static constexpr int nodes = Degree + 1;                                               ///< of the curve
  static constexpr int points = Kind == CurveQuadrature::lobatto ? Degree + 1 : Degree;  ///< of the quadrature
  std::array<double, std::size_t(nodes)> curve_node;                                     ///< d_j
  std::array<double, std::size_t(points)> node;                                          ///< c_i
  std::array<double, std::size_t(points)> weight;                                        ///< b_i
  std::array<std::array<double, std::size_t(nodes)>, std::size_t(points)> value;  ///< [i][j]: of polynomial j at c_i
  std::array<std::array<double, std::size_t(nodes)>, std::size_t(points)> derivative;  ///< [i][j]

  CurveRule() {
    const LobattoNodes<Degree> lobatto;
    curve_node = lobatto.node;
    if constexpr (Kind == CurveQuadrature::gauss) {
      const GaussNodes<Degree> gauss;
      node = gauss.node;
      weight = gauss.weight;
    } else {
      const LobattoNodes<points - 1> ends_among_them;
      node = ends_among_them.node;
      weight = ends_among_them.weight;
    }
    for (std::size_t i = 0; i < std::size_t(points); ++i) {
      double sum = 0;  // of the derivatives: that of the constant one is zero
      for (std::size_t j = 0; j < std::size_t(nodes); ++j) {
        value[i][j] = product(node[i], j, j);
        derivative[i][j] = 0;
        for (std::size_t k = 0; k < std::size_t(nodes); ++k)
          if (k != j) derivative[i][j] += product(node[i], j, k) / (curve_node[j] - curve_node[k]);
        sum += derivative[i][j];
      }
      derivative[i][i < std::size_t(nodes) ? i : 0] -= sum;
    }
  }

  static const CurveRule& rule() {
    static const CurveRule the_rule;
    return the_rule;
  }

 private:
  /// The factors (c - d_m) / (d_j - d_m) of polynomial j but those of m = j and m = k.
  double product(double c, std::size_t j, std::size_t k) const {
    double p = 1;
    for (std::size_t m = 0; m < std::size_t(nodes); ++m)
      if (m != j && m != k) p *= (c - curve_node[m]) / (curve_node[j] - curve_node[m]);
    return p;
  }
};

}  // namespace lagroid
