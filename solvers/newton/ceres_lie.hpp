#pragma once
/// Equations f(z tau(v)) = 0 on source fibres as least squares in v for Ceres: version 2 of lie_newton.hpp with a trust
/// region, to compare with.
///
///     const GroupoidFibre<SO3> fibre(SO3::exp(Vector<double, 3>(0.4, -0.2, 0.9)));
///     const AutomaticField field(fibre, [](const auto& y) { return y.diagonal().eval(); });  // lie_differentials.hpp
///     const auto found = solve_by_ceres(ImplicitStep{fibre, field, 0.5}, Vector<double, 3>::Zero());  // h = 0.5
///
/// Requires what lie_newton.hpp does. Status: `stagnated` at a minimum of |f| where f is not zero, `not_finite`,
/// `not_converged`. Throws MissingLibrary in a build without Ceres.

#include <lagroid/solvers/newton/lie_newton.hpp>

#include <functional>

namespace lagroid {

namespace detail {

/// f and, where `derivative` is not null, its matrix of derivatives at v; false where they are not finite.
using ChartFunction = std::function<bool(const Eigen::VectorXd& v, Eigen::VectorXd& f, Eigen::MatrixXd* derivative)>;

struct CeresRoot {
  Eigen::VectorXd v;
  int iterations = 0;
};

/// Levenberg-Marquardt on |f(v)|^2 / 2 to the limits of double precision.
CeresRoot minimise_by_ceres(const ChartFunction& function, Eigen::VectorXd start, int max_iterations);

}  // namespace detail

/// f(z tau(v)) = 0 as a least-squares problem of zero residual in the coordinates v, from `start`: version 2 with a
/// trust region. Of the options, tolerance and max_iterations apply. Ceres' own verdict is not used: the status follows
/// from the residual, evaluated anew; `stagnated` is a minimum, or a place that Ceres took for one, where f is not
/// zero.
template <FibreEquation E>
LieNewtonResult<typename E::Fibre> solve_by_ceres(const E& equation, const typename E::Fibre::Vector& start,
                                                  const LieNewtonOptions& options = {}) {
  using Fibre = typename E::Fibre;
  const Fibre& fibre = equation.fibre();
  LieNewtonResult<Fibre> out;
  const auto root = detail::minimise_by_ceres(
      [&](const Eigen::VectorXd& x, Eigen::VectorXd& f, Eigen::MatrixXd* derivative) {
        const typename Fibre::Vector v = x;
        const auto y = fibre.at(v);
        f = equation.residual(y, v);
        if (derivative != nullptr) *derivative = equation.chart_differential(y, v);
        return f.allFinite() && (derivative == nullptr || derivative->allFinite());
      },
      start, options.max_iterations);
  out.v = root.v;
  out.y = fibre.at(out.v);
  out.iterations = root.iterations;
  out.residual = norm_of(equation, equation.residual(out.y, out.v));
  if (!std::isfinite(out.residual)) {
    out.status = SolveStatus::not_finite;
  } else if (out.residual <= options.tolerance) {
    out.status = SolveStatus::converged;
  } else {
    out.status = out.iterations >= options.max_iterations ? SolveStatus::not_converged : SolveStatus::stagnated;
  }
  return out;
}

}  // namespace lagroid
