#pragma once
/// The Newton iteration on Lie groups ([N]), on the alpha-fibres of any groupoid.

#include <lagroid/core/alpha_fibre.hpp>
#include <lagroid/solvers/status.hpp>

#include <Eigen/LU>

#include <cmath>
#include <limits>
#include <vector>

namespace lagroid {

/// An equation f(y) = 0 on a fibre, f with values in the algebra (the fibre of AG):
///
///     equation.fibre()                  its AlphaFibre
///     equation.residual(y, v)           f(y), v the coordinates of y
///     equation.differential(y, v)       the matrix of df_y(u) = d/dt f(y tau(t u))                        [N] (3.4)
///     equation.chart_differential(y, v) the matrix of d/dt f(z tau(v + t u)) = df_y dtau_v (u)            [N] (3.19)
///     equation.norm(f)                  by which residuals are judged
template <class E>
concept FibreEquation = AlphaFibre<typename E::Fibre> &&
    requires(const E& e, const typename E::Fibre::Point& y, const typename E::Fibre::Vector& v) {
  { e.fibre() } -> std::convertible_to<const typename E::Fibre&>;
  { e.residual(y, v) } -> std::convertible_to<typename E::Fibre::Vector>;
  { e.differential(y, v) } -> std::convertible_to<typename E::Fibre::Matrix>;
  { e.chart_differential(y, v) } -> std::convertible_to<typename E::Fibre::Matrix>;
  { e.norm(v) } -> std::convertible_to<double>;
};

/// y = z tau(h g(y)): one step of the implicit Euler method for y' = y g(y), as f(y) = v(y) - h g(y) ([N] (1.1),
/// (3.6)). `Field` supplies the vector g(y) and the matrix dg(y) of dg_y(u) = d/dt g(y tau(t u)).
template <AlphaFibre F, class Field> class ImplicitStep {
 public:
  using Fibre = F;
  using Point = typename F::Point;
  using Vector = typename F::Vector;
  using Matrix = typename F::Matrix;

  ImplicitStep(F fibre, Field field, double h) : fibre_(std::move(fibre)), field_(std::move(field)), h_(h) {}

  const F& fibre() const { return fibre_; }
  const Field& field() const { return field_; }
  double step() const { return h_; }
  Vector residual(const Point& y, const Vector& v) const { return v - h_ * field_.g(y); }
  /// dtau_v^{-1} - h dg_y ([N] (3.8)).
  Matrix differential(const Point& y, const Vector& v) const { return fibre_.dtau_inverse(v) - h_ * field_.dg(y); }
  /// 1 - h dg_y dtau_v ([N] (3.22)).
  Matrix chart_differential(const Point& y, const Vector& v) const {
    Matrix m = -h_ * field_.dg(y) * fibre_.dtau(v);
    m.diagonal().array() += 1;
    return m;
  }
  double norm(const Vector& f) const { return fibre_.norm(f); }

 private:
  F fibre_;
  Field field_;
  double h_;
};

/// Version 1 moves y by tau(u) on the fibre; version 2 moves the coordinates, v + u; the fixed point iteration is
/// (1.2).
enum class LieIteration { version1, version2, fixed_point };

struct LieNewtonOptions {
  LieIteration iteration = LieIteration::version1;
  double tolerance = 1e-13;
  int max_iterations = 100;
};

/// How an iteration went. `residuals` has the norm of f at the start and after each iteration.
template <class F> struct LieNewtonResult {
  SolveStatus status = SolveStatus::not_converged;
  typename F::Point y;
  typename F::Vector
      v;  ///< coordinates of y: below the principal branch's reach in version 1, of any size in version 2
  std::vector<double> residuals;
  int iterations() const { return int(residuals.size()) - 1; }
  bool converged() const { return status == SolveStatus::converged; }
};

/// Iterates from y = z tau(v). The iterate with the last residual is returned, whatever the status:
/// `left_domain` where y has no coordinates any more, `not_finite`, `not_converged` at the limit.
template <FibreEquation E>
LieNewtonResult<typename E::Fibre> lie_newton(const E& equation, typename E::Fibre::Vector v,
                                              const LieNewtonOptions& options = {}) {
  using Vector = typename E::Fibre::Vector;
  const auto& fibre = equation.fibre();
  LieNewtonResult<typename E::Fibre> out;
  out.y = fibre.at(v);
  out.v = v;
  while (true) {
    const Vector f = equation.residual(out.y, out.v);
    out.residuals.push_back(equation.norm(f));
    if (!std::isfinite(out.residuals.back())) {
      out.status = SolveStatus::not_finite;
      return out;
    }
    if (out.residuals.back() <= options.tolerance) {
      out.status = SolveStatus::converged;
      return out;
    }
    if (out.iterations() == options.max_iterations) return out;
    switch (options.iteration) {
      case LieIteration::version1: {
        const Vector u = equation.differential(out.y, out.v).partialPivLu().solve(f);
        out.y = fibre.moved(out.y, -u);
        const auto coordinates = fibre.coordinates(out.y);
        if (!coordinates) {
          out.status = SolveStatus::left_domain;
          return out;
        }
        out.v = *coordinates;
        break;
      }
      case LieIteration::version2:
        out.v -= equation.chart_differential(out.y, out.v).partialPivLu().solve(f);
        out.y = fibre.at(out.v);
        break;
      case LieIteration::fixed_point:  // v - f(y) = h g(y)
        out.v -= f;
        out.y = fibre.at(out.v);
        break;
    }
  }
}

}  // namespace lagroid
