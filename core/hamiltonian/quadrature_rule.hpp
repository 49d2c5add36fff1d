#pragma once
/// Quadrature on [0, 1]: sum_i b_i f(c_i), the integral of f for polynomials of degree below `order`.
///
/// Discrete Lagrangians are quadratures of the action over a step, and their order is that of the rule.
///
///     const QuadratureRule& rule = quadrature_rules::simpson;
///     double sum = 0;
///     for (std::size_t i = 0; i < rule.nodes.size(); ++i) sum += rule.weights[i] * f(rule.nodes[i]);

#include <array>
#include <span>
#include <string_view>

namespace lagroid {

/// sum b_i f(c_i), which is the integral of f for polynomials of degree below `order`. Refers to numbers that must
/// outlive it.
struct QuadratureRule {
  std::string_view name;
  int order;
  std::span<const double> nodes;    ///< c_i
  std::span<const double> weights;  ///< b_i
};

namespace detail::quadrature {

inline constexpr std::array<double, 1> zero{0};
inline constexpr std::array<double, 1> half{0.5};
inline constexpr std::array<double, 1> unity{1};
inline constexpr std::array<double, 2> ends{0, 1};
inline constexpr std::array<double, 2> halves{0.5, 0.5};
inline constexpr std::array<double, 3> simpson_nodes{0, 0.5, 1};
inline constexpr std::array<double, 3> simpson_weights{1.0 / 6, 2.0 / 3, 1.0 / 6};
/// 1/2 -+ sqrt(3) / 6.
inline constexpr std::array<double, 2> gauss_2_nodes{0.21132486540518711774542560, 0.78867513459481288225457440};
/// 1/2 -+ sqrt(15) / 10.
inline constexpr std::array<double, 3> gauss_3_nodes{0.11270166537925831148207346, 0.5, 0.88729833462074168851792654};
inline constexpr std::array<double, 3> gauss_3_weights{5.0 / 18, 4.0 / 9, 5.0 / 18};
/// 1/2 -+ sqrt(5) / 10.
inline constexpr std::array<double, 4> lobatto_4_nodes{0, 0.27639320225002103035908263, 0.72360679774997896964091737,
                                                       1};
inline constexpr std::array<double, 4> lobatto_4_weights{1.0 / 12, 5.0 / 12, 5.0 / 12, 1.0 / 12};

}  // namespace detail::quadrature

namespace quadrature_rules {

inline constexpr QuadratureRule rectangle{"rectangle", 1, detail::quadrature::zero, detail::quadrature::unity};
inline constexpr QuadratureRule right_rectangle{"right-rectangle", 1, detail::quadrature::unity,
                                                detail::quadrature::unity};
inline constexpr QuadratureRule midpoint{"midpoint", 2, detail::quadrature::half, detail::quadrature::unity};
inline constexpr QuadratureRule trapezoid{"trapezoid", 2, detail::quadrature::ends, detail::quadrature::halves};
inline constexpr QuadratureRule simpson{"simpson", 4, detail::quadrature::simpson_nodes,
                                        detail::quadrature::simpson_weights};
inline constexpr QuadratureRule gauss_2{"gauss-2", 4, detail::quadrature::gauss_2_nodes, detail::quadrature::halves};
inline constexpr QuadratureRule gauss_3{"gauss-3", 6, detail::quadrature::gauss_3_nodes,
                                        detail::quadrature::gauss_3_weights};
inline constexpr QuadratureRule lobatto_4{"lobatto-4", 6, detail::quadrature::lobatto_4_nodes,
                                          detail::quadrature::lobatto_4_weights};

inline constexpr std::array<QuadratureRule, 8> all{rectangle, right_rectangle, midpoint, trapezoid,
                                                   simpson,   gauss_2,         gauss_3,  lobatto_4};

}  // namespace quadrature_rules

}  // namespace lagroid
