#pragma once
/// The Newton iteration on Lie groups, on the source fibres of any groupoid, for f(y) = 0 with values in the algebra:
///
///     df_y(u) = -f(y),    y <- y tau(u)             version 1, on the group
///     df_y dtau_v(w) = -f(y),    v <- v + w         version 2, in the coordinates y = z tau(v)
///
/// Implicit steps y = z tau(h g(y)) are such equations, and fixed-point iteration solves them for small h only.
///
///     const GroupoidFibre<SO3> fibre(SO3::exp(Vector<double, 3>(0.4, -0.2, 0.9)));
///     const AutomaticField field(fibre, [](const auto& y) { return y.diagonal().eval(); });  // lie_differentials.hpp
///     const auto found = lie_newton(ImplicitStep{fibre, field, 0.5}, Vector<double, 3>::Zero());  // h = 0.5
///
/// Requires an equation as `FibreEquation` describes it, and a start. Returns the last iterate with residual,
/// iterations and status: `left_domain` (y has no coordinates any more), `singular` (df has no inverse), `stagnated`
/// (damping found no smaller residual), `not_finite`, `not_converged`. [N] sections 3 and 5

#include <lagroid/core/matrices/factored_matrix.hpp>
#include <lagroid/core/source_fibre.hpp>
#include <lagroid/solvers/status.hpp>

#include <Eigen/LU>

#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>
#include <vector>

namespace lagroid {

/// An equation f(y) = 0 on a fibre, f with values in the algebra (the fibre of AG):
///
///     equation.fibre()                  its SourceFibre
///     equation.residual(y, v)           f(y), v the coordinates of y
///     equation.differential(y, v)       the matrix of df_y(u) = d/dt f(y tau(t u))                        [N] (3.4)
///     equation.chart_differential(y, v) the matrix of d/dt f(z tau(v + t u)) = df_y dtau_v (u)            [N] (3.19)
///     equation.norm(f)                  by which residuals are judged
template <class E>
concept FibreEquation = SourceFibre<typename E::Fibre> &&
    requires(const E& e, const typename E::Fibre::Point& y, const typename E::Fibre::Vector& v) {
  { e.fibre() } -> std::convertible_to<const typename E::Fibre&>;
  { e.residual(y, v) } -> std::convertible_to<typename E::Fibre::Vector>;
  { e.differential(y, v) } -> std::convertible_to<typename E::Fibre::Matrix>;
  { e.chart_differential(y, v) } -> std::convertible_to<typename E::Fibre::Matrix>;
  { e.norm(v) } -> std::convertible_to<double>;
};

/// y = z tau(h g(y)): one step of the implicit Euler method for y' = y g(y), as f(y) = v(y) - h g(y) ([N] (1.1),
/// (3.6)). `Field` supplies the vector g(y) and the matrix dg(y) of dg_y(u) = d/dt g(y tau(t u)).
template <SourceFibre F, class Field> class ImplicitStep {
 public:
  using Fibre = F;
  using Point = typename F::Point;
  using Vector = typename F::Vector;
  using Matrix = typename F::Matrix;
  using Scalar = typename Vector::Scalar;

  ImplicitStep(F fibre, Field field, double h) : fibre_(std::move(fibre)), field_(std::move(field)), h_(h) {}

  const F& fibre() const { return fibre_; }
  const Field& field() const { return field_; }
  double step() const { return h_; }
  Vector residual(const Point& y, const Vector& v) const { return v - Scalar(h_) * field_.g(y); }
  /// dtau_v^{-1} - h dg_y ([N] (3.8)).
  Matrix differential(const Point& y, const Vector& v) const {
    return fibre_.dtau_inverse(v) - Scalar(h_) * field_.dg(y);
  }
  /// 1 - h dg_y dtau_v ([N] (3.22)).
  Matrix chart_differential(const Point& y, const Vector& v) const {
    Matrix m = -Scalar(h_) * (field_.dg(y) * fibre_.dtau(v));
    m.diagonal().array() += 1;
    return m;
  }
  double norm(const Vector& f) const { return fibre_.norm(f); }

 private:
  F fibre_;
  Field field_;
  double h_;
};

/// How an iterate y = z tau(v) is improved ([N]):
///
///     version1             df_y u = -f, then y tau(u)                              (3.5)
///     version1_by_chart    df_y dtau_v w = -f, then y tau(dtau_v w): the same      (3.13), (3.14)
///     version2             df_y dtau_v w = -f, then z tau(v + w)                   (3.20)
///     fixed_point          w = -f, then z tau(v + w)                               (1.2)
enum class LieIteration { version1, version1_by_chart, version2, fixed_point };

struct LieNewtonOptions {
  LieIteration iteration = LieIteration::version1;
  double tolerance = 1e-13;
  int max_iterations = 100;  ///< at least 0
  /// Damping: an update that does not lower the norm of f is halved up to this many times, and then refused: the
  /// iteration ends as `stagnated` where it stands. 0: every update is taken.
  int halvings = 0;
  /// Step control: a longer update (in the fibre's norm) is shortened to this, which is not negative.
  double longest_update = std::numeric_limits<double>::infinity();
};

/// How an iteration ended, and its last iterate, whatever the status.
template <class F> struct LieNewtonResult {
  SolveStatus status = SolveStatus::not_converged;
  typename F::Point y;
  /// Coordinates of y: on the principal branch in version 1, of any size in version 2.
  typename F::Vector v;
  double residual = 0;  ///< the norm of f there
  int iterations = 0;
  bool converged() const { return status == SolveStatus::converged; }
};

/// The norm of f, which a norm of its own may pass over where it is not a number.
template <FibreEquation E> double norm_of(const E& equation, const typename E::Fibre::Vector& f) {
  return f.allFinite() ? equation.norm(f) : std::numeric_limits<double>::quiet_NaN();
}

/// The order that the norms of f show, at the start and after each iteration ([N] section 5): the last one left out,
/// which may be round-off. NaN for fewer than three iterations.
inline double observed_order(const std::vector<double>& norms) {
  if (norms.size() < 4) return std::numeric_limits<double>::quiet_NaN();
  const auto last = norms.end();
  return std::log(last[-2] / last[-3]) / std::log(last[-3] / last[-4]);
}

/// The iteration from y = z tau(v); `observe` is called with the norm of f at the start and after each iteration.
/// `left_domain` where y has no coordinates any more, `singular` where the differential has no inverse, `not_finite`,
/// `stagnated` where damping refused, `not_converged` at the limit.
template <FibreEquation E, class Observe>
LieNewtonResult<typename E::Fibre> lie_newton(const E& equation, const typename E::Fibre::Vector& start,
                                              const LieNewtonOptions& options, const Observe& observe) {
  using Fibre = typename E::Fibre;
  using Vector = typename Fibre::Vector;
  const Fibre& fibre = equation.fibre();
  LieNewtonResult<Fibre> out;
  out.y = fibre.at(start);
  out.v = start;

  const auto solved = [](const auto& matrix, const Vector& f) -> Vector {
    using Matrix = std::remove_cvref_t<decltype(matrix)>;
    if constexpr (Matrix::SizeAtCompileTime == Eigen::Dynamic) {
      return FactoredMatrix<typename Matrix::Scalar>(matrix).solve(f);
    } else {
      return matrix.partialPivLu().solve(f);
    }
  };
  const auto update = [&](const Vector& f) -> Vector {
    switch (options.iteration) {
      case LieIteration::version1:
        return -solved(equation.differential(out.y, out.v), f);
      case LieIteration::version1_by_chart:
        return -(fibre.dtau(out.v) * solved(equation.chart_differential(out.y, out.v), f));
      case LieIteration::version2:
        return -solved(equation.chart_differential(out.y, out.v), f);
      case LieIteration::fixed_point:
        break;
    }
    return -f;
  };
  const bool on_the_fibre =
      options.iteration == LieIteration::version1 || options.iteration == LieIteration::version1_by_chart;

  Vector f = equation.residual(out.y, out.v);
  out.residual = norm_of(equation, f);
  observe(out.residual);
  for (; std::isfinite(out.residual) && !(out.residual <= options.tolerance); ++out.iterations) {
    if (out.iterations >= options.max_iterations) return out;
    Vector u = update(f);
    if (!u.allFinite()) {
      out.status = SolveStatus::singular;
      return out;
    }
    if (const double size = fibre.norm(u); size > options.longest_update) u *= options.longest_update / size;
    for (int halving = 0;; ++halving) {
      const auto y = on_the_fibre ? fibre.moved(out.y, u) : fibre.at(out.v + u);
      const auto v = on_the_fibre ? fibre.coordinates(y) : std::optional<Vector>(out.v + u);
      if (v) {
        f = equation.residual(y, *v);
        const double residual = norm_of(equation, f);
        if (options.halvings == 0 || residual < out.residual) {
          out.y = y;
          out.v = *v;
          out.residual = residual;
          break;
        }
      }
      if (halving == options.halvings) {
        out.status = v ? SolveStatus::stagnated : SolveStatus::left_domain;
        return out;
      }
      u *= 0.5;
    }
    observe(out.residual);
  }
  out.status = std::isfinite(out.residual) ? SolveStatus::converged : SolveStatus::not_finite;
  return out;
}

template <FibreEquation E>
LieNewtonResult<typename E::Fibre> lie_newton(const E& equation, const typename E::Fibre::Vector& start,
                                              const LieNewtonOptions& options = {}) {
  return lie_newton(equation, start, options, [](double) {});
}

}  // namespace lagroid
