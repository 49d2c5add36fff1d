#pragma once
/// The equations of one step, F-(g, lambda) = mu, phi(g) = 0, C(beta(g)) = 0, their matrix, and its condition.
///
/// Every solver of steps has these equations and this matrix; where the matrix is regular, the step depends smoothly on
/// the state.
///
///     const auto d = two_sided(system, step.arrow, step.multipliers);
///     const auto residual = StepEquations<Sys>::residual(d, momentum);  // zero at a step from (alpha(g), momentum)
///     const double condition = regularity_condition(system, step);     // infinite where the system is not regular
///
/// Nothing throws.
///
/// Source: [G] Def. 3.3, Def. 3.5, Corollary 3.4.

#include <lagroid/core/derivatives/two_sided.hpp>

#include <Eigen/SVD>

#include <cmath>

namespace lagroid {

/// The step equations F-(g, lambda) = mu, phi(g) = 0, C(beta(g)) = 0, in the unknowns (w, lambda), g <- g tau(w).
///
/// For object constraints F- contains lambda . dC o rho at the source, the impulse between two arrows.
template <class Sys, class S = double> struct StepEquations {
  static constexpr int size = Sys::dimension + Sys::constraints;
  /// Not aligned, so that Eigen reads it number by number, as it is written.
  using Residual = Eigen::Matrix<S, size, 1, Eigen::DontAlign>;
  using Jacobian = Matrix<S, size, size>;

  static Residual residual(const GradientsOf<Sys, S>& d,
                           const AlgebroidVector<typename Sys::GroupoidType, S>& momentum) {
    Residual r;
    r.template head<Sys::dimension>() = -d.source_gradient - momentum;
    r.template tail<Sys::constraints>() = d.constraint;
    return r;
  }

  /// [ -d2f/dv dw   -(d(phi, C o alpha)/dv)^T ;  d(phi, C o beta)/dw   0 ].
  static Jacobian jacobian(const TwoSidedOf<Sys>& d) {
    Jacobian j;
    j.template topLeftCorner<Sys::dimension, Sys::dimension>() = -d.mixed;
    j.template topRightCorner<Sys::dimension, Sys::constraints>() = -d.constraint_source;
    j.template bottomLeftCorner<Sys::constraints, Sys::dimension>() = d.constraint_target;
    j.template bottomRightCorner<Sys::constraints, Sys::constraints>().setZero();
    return j;
  }
};

/// Row and column scales, powers of two, with which a matrix has rows and columns of largest entry near one.
template <int Rows, int Columns = Rows> struct Scaling {
  Vector<double, Rows> row;
  Vector<double, Columns> column;

  Matrix<double, Rows, Columns> apply(const Matrix<double, Rows, Columns>& a) const {
    return row.asDiagonal() * a * column.asDiagonal();
  }

  /// Ruiz's simultaneous equilibration. Zero rows and columns keep scale one.
  static Scaling equilibrate(const Matrix<double, Rows, Columns>& a) {
    Scaling s{Vector<double, Rows>::Ones(a.rows()), Vector<double, Columns>::Ones(a.cols())};
    const auto inverse_root = [](double x) { return x > 0 && std::isfinite(x) ? 1 / std::sqrt(x) : 1.0; };
    for (int sweep = 0; sweep < 8; ++sweep) {
      const Matrix<double, Rows, Columns> b = s.apply(a).cwiseAbs();
      for (int i = 0; i < b.rows(); ++i) s.row(i) *= inverse_root(b.row(i).maxCoeff());
      for (int j = 0; j < b.cols(); ++j) s.column(j) *= inverse_root(b.col(j).maxCoeff());
    }
    const auto power_of_two = [](double x) { return std::exp2(std::round(std::log2(x))); };
    s.row = s.row.unaryExpr(power_of_two);
    s.column = s.column.unaryExpr(power_of_two);
    return s;
  }
};

/// The condition number of the equilibrated matrix of T F- at a point of Sigma_L; infinite where the system is not
/// regular ([G] Def. 3.5). For arrow constraints the matrix of T F+ is its transpose
/// up to signs, so that one number serves both, which is Corollary 3.4 of [G].
template <DiscreteSystem Sys> double regularity_condition(const Sys& system, const Step<Sys>& step) {
  using E = StepEquations<Sys>;
  const auto j = E::jacobian(two_sided(system, step.arrow, step.multipliers));
  const typename E::Jacobian scaled = Scaling<E::size>::equilibrate(j).apply(j);
  const auto sigma = Eigen::JacobiSVD<typename E::Jacobian>(scaled).singularValues().eval();
  return sigma(0) / sigma(E::size - 1);
}

}  // namespace lagroid
