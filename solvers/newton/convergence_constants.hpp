#pragma once
/// The constants of Newton's iteration on a Lie group at a solution y, f(y) = 0, and what they predict: with
///
///     eta >= |df_y^{-1}|,    gamma >= |df_{y exp(u)} - df_y| / |u|,    y^{-1} y_n = exp(v_n),
///
/// version 1 has |v_{n+1}| <= eta gamma |v_n|^2 (Theorem 4.6), and version 2 the same of the differential in
/// coordinates and of the distance there (Theorem 4.4), to leading order in v: both constants are those of the
/// solution, not of a ball around it. 1 / (eta gamma) is the distance from which on that leading term falls; where the
/// next ones are larger, as of v - v^3 at zero, the basin is smaller.
///
///     const auto constants = convergence_constants(step, found, LieIteration::version1);
///     const double radius = constants.radius();
///
/// Requires a solution, to round-off, and an f that is three times differentiable there. gamma is that of the limit u
/// -> 0, the norm of a bilinear map, found by alternating maximisation from every direction of a basis: where it does
/// not find the largest value it is a lower one. Returns numbers that are none where df is singular. Nothing throws.
///
/// Source: [N] (4.11) to (4.13), Theorems 4.4 and 4.6.

#include <lagroid/solvers/newton/lie_newton.hpp>

#include <Eigen/SVD>

#include <algorithm>
#include <limits>
#include <vector>

namespace lagroid {

struct ConvergenceConstants {
  double eta;
  double gamma;
  /// |v_0| below which the leading term falls.
  double radius() const { return 1 / (eta * gamma); }
};

/// Of version 1 on the group, or of version 2 in coordinates.
template <FibreEquation E>
ConvergenceConstants convergence_constants(const E& equation, const LieNewtonResult<typename E::Fibre>& at,
                                           LieIteration iteration) {
  using Dense = Eigen::MatrixXd;
  using Vector = typename E::Fibre::Vector;
  const auto& fibre = equation.fibre();
  const bool on_the_group = iteration != LieIteration::version2;
  const Eigen::Index n = at.v.size();
  const auto differential = [&](const Vector& u) -> Dense {
    if (!on_the_group) return equation.chart_differential(fibre.at(Vector(at.v + u)), Vector(at.v + u));
    const auto y = fibre.moved(at.y, u);
    const auto v = fibre.coordinates(y);
    if (!v) return Dense::Constant(n, n, std::numeric_limits<double>::quiet_NaN());
    return equation.differential(y, *v);
  };
  std::vector<Dense> slopes;  // of the differential, along each direction
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto quotient = [&](double size) {
      Vector u = Vector::Zero(n);
      u(i) = size;
      const Vector back = -u;
      return Dense((differential(u) - differential(back)) / (2 * size));
    };
    slopes.push_back((4 * quotient(1e-3) - quotient(2e-3)) / 3);
  }
  const Vector none = Vector::Zero(n);
  const Dense here = differential(none);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  if (!here.allFinite()) return {nan, nan};
  const double least = Eigen::JacobiSVD<Dense>(here).singularValues()(n - 1);
  ConvergenceConstants out{least > 0 ? 1 / least : nan, 0};
  constexpr int passes = 30;
  for (Eigen::Index first = 0; first < n; ++first) {
    Eigen::VectorXd u = Eigen::VectorXd::Unit(n, first);
    for (int pass = 0; pass < passes && u.norm() > 0; ++pass) {
      u.normalize();
      Dense along = Dense::Zero(n, n);
      for (Eigen::Index i = 0; i < n; ++i) along += u(i) * slopes[std::size_t(i)];
      const Eigen::JacobiSVD<Dense> svd(along, Eigen::ComputeThinU | Eigen::ComputeThinV);
      out.gamma = std::max(out.gamma, svd.singularValues()(0));
      for (Eigen::Index i = 0; i < n; ++i)
        u(i) = svd.matrixU().col(0).dot(slopes[std::size_t(i)] * svd.matrixV().col(0));
    }
  }
  return out;
}

}  // namespace lagroid
