#include <lagroid/solvers/optimisation/sensitivity/minimum_derivatives.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace lagroid::optimisation {

std::string_view to_string(MinimumStatus status) {
  switch (status) {
    case MinimumStatus::strict:
      return "strict";
    case MinimumStatus::not_strict:
      return "not_strict";
    case MinimumStatus::no_minimum:
      return "no_minimum";
    case MinimumStatus::not_critical:
      return "not_critical";
    case MinimumStatus::iteration_limit:
      return "iteration_limit";
    case MinimumStatus::not_finite:
      return "not_finite";
  }
  return "unknown";
}

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr double precision = std::numeric_limits<double>::epsilon();

double digits_of(double relative_error) {
  return std::isfinite(relative_error) ? std::clamp(-std::log10(std::max(relative_error, 1e-16)), 0.0, 16.0) : 0;
}

double largest_finite(const Eigen::RowVectorXd& numbers) {
  return numbers.size() > 0 ? numbers.array().isFinite().select(numbers.array().abs(), 0.0).maxCoeff() : 0;
}

/// Value and minimiser at one point, with all that is known there.
class AtMinimum {
 public:
  AtMinimum(const Manifold& manifold, const ParametricObjective& objective, const MinimumOptions& options)
      : manifold_(manifold), objective_(objective), options_(options), problem_(manifold, objective) {}

  MinimumDerivatives differentiate(const Point& x, const std::vector<ParameterEntry>& by);

 private:
  /// Whether numbers came of it.
  bool evaluate(EvaluatedPoint& state);
  double norm(const Vector& v) const { return manifold_.norm(state_.x, v); }
  double slope() const { return norm(state_.gradient); }
  double rounding() const;
  double unit() const;
  bool correct();
  bool classify();
  void differentiate_value();
  bool differentiate_minimiser();
  /// d_k f, its slope on the manifold, and the size of what that is a part of.
  struct SlopeOf {
    double value;
    Vector slope;
    double size;
  };
  SlopeOf by_parameter(Eigen::Index k, const Point& x) const;
  double rate_of_change(const Vector& signs);
  double relative_residual(const Eigen::VectorXd& residuals, const Vector& signs) const;
  void end(MinimumStatus status, std::string message);

  const Manifold& manifold_;
  const ParametricObjective& objective_;
  MinimumOptions options_;
  Problem problem_;
  EvaluatedPoint state_;
  Vector left_;             ///< the step that Newton's method would take next; empty where there is none
  Eigen::MatrixXd slopes_;  ///< grad d_k f, a column for each parameter
  Eigen::VectorXd sizes_;   ///< of what they are parts of
  MinimumDerivatives out_;
};

void AtMinimum::end(MinimumStatus status, std::string message) {
  out_.status = status;
  out_.message = std::move(message);
}

bool AtMinimum::evaluate(EvaluatedPoint& state) {
  problem_.evaluate(state);
  return std::isfinite(state.value) && std::isfinite(manifold_.inner(state.x, state.gradient, state.gradient));
}

/// What rounding leaves of a slope that vanishes: that of the differential that it is the tangent part of. In a metric
/// of the manifold's own there is no such part.
double AtMinimum::rounding() const { return manifold_.has_own_metric() ? 0 : precision * state_.euclidean.norm(); }

/// A length that is not small. Manifolds with a metric of their own have no other than the radius of their curvature.
double AtMinimum::unit() const {
  if (manifold_.has_own_metric()) return 1;
  return std::max(1.0, state_.x.norm() / std::sqrt(double(state_.x.size())));
}

/// Newton's method, as long as it takes the slope away. Along a flat direction there is none to be taken, but rounding,
/// and a step that leaves little else will do. False where what is left is no rounding.
bool AtMinimum::correct() {
  const ManifoldRetraction retraction = chosen_retraction(manifold_, {});
  double largest = 0;
  for (int k = 0;; ++k) {
    TangentSolver solver(problem_, state_, options_.solver);
    Vector step;
    const TangentSolveStatus status = solver.solve(-state_.gradient, step, 0.1 * rounding());
    out_.iterations += solver.iterations();
    largest = std::max(largest, solver.largest_curvature());
    left_ = status == TangentSolveStatus::solved || solver.residual() <= 0.1 * slope() ? step : Vector();
    if (left_.size() == 0 || k == options_.corrections) break;
    EvaluatedPoint next;
    if (!manifold_.retract(retraction, state_.x, step, next.x) || !evaluate(next)) break;
    if (!(manifold_.norm(next.x, next.gradient) < 0.5 * slope())) break;
    state_ = std::move(next);
  }
  constexpr double small = 1e-6;
  return slope() <= std::max(small * largest * unit(), 10 * rounding());
}

/// Whether the Hessian is positive, zero or negative along its least direction. False where nothing holds there.
bool AtMinimum::classify() {
  TangentSolver solver(problem_, state_, options_.solver);
  Vector direction;
  const TangentSolveStatus status = solver.least_curvature(out_.least_curvature, direction);
  out_.iterations += solver.iterations();
  out_.largest_curvature = solver.largest_curvature();
  // Along a direction that f does not see a slope that is left seems to be a curvature.
  const bool is_of_slope = std::abs(out_.least_curvature) <= 10 * slope() / unit();
  if (status == TangentSolveStatus::flat || (status == TangentSolveStatus::falling && is_of_slope)) {
    end(MinimumStatus::not_strict,
        fmt::format(
            "the minimum is not strict: along a tangent direction the Hessian vanishes (curvatures there and at "
            "most: {:.1e} and {:.1e}), so that the minimiser has no derivative",
            out_.least_curvature, out_.largest_curvature));
    return true;
  }
  if (status == TangentSolveStatus::falling)
    end(MinimumStatus::no_minimum,
        fmt::format("f falls along a tangent direction, where its curvature is {:.2e}: this is no minimum; begin "
                    "elsewhere",
                    out_.least_curvature));
  else if (status == TangentSolveStatus::iteration_limit)
    end(MinimumStatus::iteration_limit,
        fmt::format("{} steps of conjugate gradients did not solve with the Hessian; scale the problem better",
                    solver.iterations()));
  else if (status == TangentSolveStatus::not_finite)
    end(MinimumStatus::not_finite, "the Hessian is not finite at the minimum; look at the data");
  else
    out_.status = MinimumStatus::strict;
  return out_.strict();
}

AtMinimum::SlopeOf AtMinimum::by_parameter(Eigen::Index k, const Point& x) const {
  SlopeOf out{no_number, Vector::Zero(x.size()), 0};
  out.value = objective_.by_parameter(out_.parameters[std::size_t(k)], x, out.slope);
  if (!manifold_.has_own_metric()) out.size = out.slope.norm();
  manifold_.gradient(x, out.slope);
  if (!out.slope.allFinite()) out.slope.setConstant(no_number);
  out.size = std::max(out.size, manifold_.norm(x, out.slope));
  return out;
}

/// d_k f where no flat direction has a part of its slope. To first order all minima beside this one then have the same.
void AtMinimum::differentiate_value() {
  const auto count = Eigen::Index(out_.parameters.size());
  slopes_.resize(state_.x.size(), count);
  sizes_.resize(count);
  out_.length = unit();
  constexpr double eight_digits = 1e-8;
  TangentSolver solver(problem_, state_, options_.solver);
  Vector step;
  double error = 0;
  Eigen::Index without = 0;
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto [value, slope, size] = by_parameter(k, state_.x);
    slopes_.col(k) = slope;
    sizes_(k) = size;
    out_.value_sizes(k) = size * out_.length;
    const bool is_known = slope.allFinite();
    if (!out_.strict() && (!is_known || solver.solve(slope, step, eight_digits * size) != TangentSolveStatus::solved)) {
      ++without;
      continue;
    }
    out_.value_by(k) = value;
    error = std::max(error, precision * out_.value_sizes(k));
    if (!out_.strict() || !is_known) continue;
    const double of_rounding = manifold_.norm(state_.x, slope) * rounding() / out_.least_curvature;
    const double of_left = left_.size() > 0 ? std::abs(manifold_.inner(state_.x, slope, left_)) : 0;
    error = std::max({error, of_left, of_rounding});
  }
  out_.iterations += solver.iterations();
  if (without > 0)
    out_.message +=
        fmt::format("; by {} of {} parameters the least value has none either, as d_k f changes along such a direction",
                    without, count);
  out_.value_error = error;
  const double largest = largest_finite(out_.value_is_at_rest() ? out_.value_sizes : out_.value_by);
  out_.value_digits = largest > 0 ? digits_of(error / largest + precision) : 16;
}

/// How fast a combination of the columns changes along the way to x*, over its size: by solving for it once more, a
/// little beside.
double AtMinimum::rate_of_change(const Vector& signs) {
  Vector before = out_.minimiser_by * signs;
  const double size = norm(before);
  if (!(size > 0)) return 0;
  const double length = 1e-5 * unit();
  const Vector along =
      left_.size() > 0 && norm(left_) > 0 ? Vector(left_ * (length / norm(left_))) : Vector(before * (length / size));
  EvaluatedPoint beside;
  if (!manifold_.retract(chosen_retraction(manifold_, {}), state_.x, along, beside.x) || !evaluate(beside))
    return no_number;
  Vector sum = Vector::Zero(beside.x.size()), after;
  for (Eigen::Index k = 0; k < signs.size(); ++k)
    if (signs(k) != 0) sum -= signs(k) * by_parameter(k, beside.x).slope;
  TangentSolver solver(problem_, beside, options_.solver);
  const bool is_solved = solver.solve(sum, after) == TangentSolveStatus::solved;
  out_.iterations += solver.iterations();
  if (!is_solved) return no_number;
  manifold_.transport(state_.x, beside.x, before);
  return manifold_.norm(beside.x, after - before) / (length * size) + 1 / unit();
}

/// What residuals and rounding leave of the columns of a table, relative to its largest: of the worst table whose
/// columns have a digit more than that. Not a number where none has.
double AtMinimum::relative_residual(const Eigen::VectorXd& residuals, const Vector& signs) const {
  std::map<std::size_t, std::pair<double, double>> tables;  // the largest column of each, and what is left of it
  for (Eigen::Index k = 0; k < signs.size(); ++k) {
    if (signs(k) == 0) continue;
    auto& [largest, left] = tables[out_.parameters[std::size_t(k)].table];
    largest = std::max(largest, norm(out_.minimiser_by.col(k)));
    left = std::max(left, (residuals(k) + precision * sizes_(k)) / out_.least_curvature);
  }
  double worst = no_number;
  for (const auto& [table, of_it] : tables)
    if (of_it.first > 10 * of_it.second) worst = std::fmax(worst, of_it.second / of_it.first);
  return worst;
}

/// The columns. False where the equations of one are not solved.
bool AtMinimum::differentiate_minimiser() {
  const Eigen::Index count = slopes_.cols();
  TangentSolver solver(problem_, state_, options_.solver);
  Vector column;
  Eigen::VectorXd residuals = Eigen::VectorXd::Zero(count);
  Eigen::Index unknown = 0;
  Vector signs = Vector::Zero(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    if (!slopes_.col(k).allFinite()) {
      ++unknown;
      continue;
    }
    const TangentSolveStatus status = solver.solve(-slopes_.col(k), column, 0.1 * precision * sizes_(k));
    if (status != TangentSolveStatus::solved) {
      out_.minimiser_by.setConstant(no_number);
      end(status == TangentSolveStatus::not_finite ? MinimumStatus::not_finite : MinimumStatus::iteration_limit,
          fmt::format("the equations for the minimiser were not solved: {}; scale the problem better",
                      to_string(status)));
      return false;
    }
    out_.minimiser_by.col(k) = column;
    residuals(k) = solver.residual();
    signs(k) = k % 3 == 1 ? -1 : 1;
  }
  out_.iterations += solver.iterations();
  if (unknown > 0)
    out_.message = fmt::format(
        "of {} of {} parameters no slope of d_k f is known: the minimiser has no derivative by "
        "them here",
        unknown, count);
  const double of_equations = relative_residual(residuals, signs);
  if (!(of_equations >= 0)) {
    out_.digits = unknown < count ? 16 : 0;
    return true;
  }
  Eigen::MatrixXd& columns = out_.minimiser_by;
  const Eigen::MatrixXd found = columns;
  for (Eigen::Index k = 0; k < count; ++k)
    if (signs(k) == 0) columns.col(k).setZero();
  const double rate = rate_of_change(signs);
  columns = found;
  out_.digits =
      digits_of(rate * out_.distance + of_equations + precision * out_.largest_curvature / out_.least_curvature);
  return true;
}

MinimumDerivatives AtMinimum::differentiate(const Point& x, const std::vector<ParameterEntry>& by) {
  const auto count = Eigen::Index(by.size());
  out_.parameters = by;
  out_.x = x;
  out_.value_by.setConstant(count, no_number);
  out_.value_sizes.setConstant(count, no_number);
  out_.minimiser_by.setConstant(manifold_.size(), count, no_number);
  state_.x = x;
  const auto told = [&] {
    out_.x = state_.x;
    out_.value = state_.value;
    out_.evaluations = problem_.evaluations();
    return out_;
  };
  if (x.size() != manifold_.size() || !x.allFinite() || !(manifold_.residual(x) <= 1e-8)) {
    end(MinimumStatus::not_finite, fmt::format("this is no point of the {}; give one", manifold_.name()));
    return out_;
  }
  if (!evaluate(state_)) {
    end(MinimumStatus::not_finite, "value or gradient at the point are not finite; look at the data");
    return told();
  }
  const bool is_critical = correct();
  out_.gradient = slope();
  if (!is_critical) {
    end(MinimumStatus::not_critical,
        fmt::format("f still has the slope {:.1e}, which Newton's method does not take away; minimise further",
                    out_.gradient));
    return told();
  }
  if (!classify()) return told();
  if (out_.strict())
    out_.distance = std::max(left_.size() > 0 ? norm(left_) : out_.gradient / out_.least_curvature,
                             rounding() / out_.least_curvature);
  differentiate_value();
  if (out_.strict() && !options_.value_alone) differentiate_minimiser();
  return told();
}

}  // namespace

bool MinimumDerivatives::value_is_at_rest() const { return largest_finite(value_by) <= 10 * value_error; }

MinimumDerivatives minimum_derivatives(const Manifold& manifold, const ParametricObjective& objective, const Point& x,
                                       const std::vector<ParameterEntry>& by, const MinimumOptions& options) {
  return AtMinimum(manifold, objective, options).differentiate(x, by);
}

}  // namespace lagroid::optimisation
