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
/// Requires degrees from one to five. Gauss's s points are exact for degree 2 s - 1, and so are Lobatto's s + 1, the
/// ends among them. Nothing throws.
///
/// Source: Hairer, Lubich, Wanner, *Geometric Numerical Integration*, 2006, II.1; Abramowitz and Stegun, 25.4.32.

#include <lagroid/core/poisson/gauss_collocation.hpp>

#include <array>
#include <cmath>
#include <cstddef>

namespace lagroid {

/// The points at which a curve is looked at.
enum class CurveQuadrature { gauss, lobatto };

/// Lobatto's nodes of degree s: the s + 1 points of [0, 1] where P_s' vanishes, and the ends, with their weights.
template <int Degree> struct LobattoNodes {
  static_assert(Degree >= 1 && Degree <= 5);
  std::array<double, std::size_t(Degree + 1)> node;
  std::array<double, std::size_t(Degree + 1)> weight;

  LobattoNodes() {
    if constexpr (Degree == 1) {
      node = {0, 1};
      weight = {0.5, 0.5};
    } else if constexpr (Degree == 2) {
      node = {0, 0.5, 1};
      weight = {1.0 / 6, 2.0 / 3, 1.0 / 6};
    } else if constexpr (Degree == 3) {
      const double r = std::sqrt(5.0) / 10;
      node = {0, 0.5 - r, 0.5 + r, 1};
      weight = {1.0 / 12, 5.0 / 12, 5.0 / 12, 1.0 / 12};
    } else if constexpr (Degree == 4) {
      const double r = std::sqrt(21.0) / 14;
      node = {0, 0.5 - r, 0.5, 0.5 + r, 1};
      weight = {1.0 / 20, 49.0 / 180, 16.0 / 45, 49.0 / 180, 1.0 / 20};
    } else {
      const double root = std::sqrt(7.0);
      const double near = std::sqrt((7 - 2 * root) / 21) / 2;
      const double far = std::sqrt((7 + 2 * root) / 21) / 2;
      node = {0, 0.5 - far, 0.5 - near, 0.5 + near, 0.5 + far, 1};
      weight = {1.0 / 30, (14 - root) / 60, (14 + root) / 60, (14 + root) / 60, (14 - root) / 60, 1.0 / 30};
    }
  }
};

/// The points and weights of a quadrature, and there the values and derivatives of the polynomials of degree s that
/// are one at one of Lobatto's nodes and zero at the others.
template <int Degree, CurveQuadrature Kind = CurveQuadrature::lobatto> struct CurveRule {
  static constexpr int nodes = Degree + 1;                                        ///< of the curve
  static constexpr int points = Kind == CurveQuadrature::gauss ? Degree : nodes;  ///< of the quadrature
  std::array<double, std::size_t(nodes)> curve_node;                              ///< d_j
  std::array<double, std::size_t(points)> node;                                   ///< c_i
  std::array<double, std::size_t(points)> weight;                                 ///< b_i
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
      node = lobatto.node;
      weight = lobatto.weight;
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
