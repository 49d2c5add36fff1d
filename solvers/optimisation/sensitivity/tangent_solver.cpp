#include <lagroid/solvers/optimisation/sensitivity/tangent_solver.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace lagroid::optimisation {

std::string_view to_string(TangentSolveStatus status) {
  switch (status) {
    case TangentSolveStatus::solved:
      return "solved";
    case TangentSolveStatus::flat:
      return "flat";
    case TangentSolveStatus::falling:
      return "falling";
    case TangentSolveStatus::iteration_limit:
      return "iteration_limit";
    case TangentSolveStatus::not_finite:
      return "not_finite";
  }
  return "unknown";
}

TangentSolver::TangentSolver(Problem& problem, const EvaluatedPoint& state, TangentSolverOptions options)
    : problem_(problem), state_(state), options_(options) {
  const Eigen::Index dimension = problem.manifold().dimension();
  if (options_.iterations <= 0) options_.iterations = 3 * dimension + 50;
  options_.kept = std::min<long>(options_.kept, dimension);
  constexpr int few = 12;
  Vector v = any_direction();
  for (int k = 0; k < few && dimension > 0; ++k) {
    apply(v);
    const double length = problem.manifold().norm(state.x, curved_);
    if (!(length > 0) || !std::isfinite(length)) break;
    v = curved_ / length;
  }
}

void TangentSolver::apply(const Vector& v) {
  problem_.hessian(state_, v, curved_);
  problem_.manifold().project(state_.x, curved_);
  const double ratio = problem_.manifold().norm(state_.x, curved_) / problem_.manifold().norm(state_.x, v);
  if (ratio > largest_) largest_ = ratio;
}

Vector TangentSolver::any_direction() const {
  std::mt19937 bits;  // its numbers are the same everywhere
  Vector out(state_.x.size());
  for (double& x : out) x = double(bits()) / 2147483648.0 - 1;
  problem_.manifold().project(state_.x, out);
  const double length = problem_.manifold().norm(state_.x, out);
  if (length > 0) out /= length;
  return out;
}

void TangentSolver::keep_orthogonal(Vector& residual) const {
  for (const Vector& each : kept_) residual -= inner(each, residual) * each;
}

TangentSolveStatus TangentSolver::iterate(const Vector& b, Vector& v, double enough) {
  const Manifold& manifold = problem_.manifold();
  v.setZero(b.size());
  left_ = b;
  manifold.project(state_.x, left_);  // of a tangent part that is rounding, rounding may be normal
  direction_ = left_;
  kept_.clear();
  double square = inner(left_, left_);
  if (!std::isfinite(square)) return TangentSolveStatus::not_finite;
  const double size = std::sqrt(square);
  for (long k = 0; k < options_.iterations; ++k, ++iterations_) {
    // No residual falls below what rounding makes of the products that it is the difference of.
    const double rounding = std::numeric_limits<double>::epsilon() * largest_ * manifold.norm(state_.x, v);
    if (std::sqrt(square) <= std::max({options_.residual * size, rounding, enough})) return TangentSolveStatus::solved;
    if (long(kept_.size()) < options_.kept) kept_.push_back(left_ / std::sqrt(square));
    apply(direction_);
    const double along = inner(direction_, direction_);
    const double curved = inner(direction_, curved_);
    if (!std::isfinite(curved) || !std::isfinite(along)) return TangentSolveStatus::not_finite;
    met_curvature_ = curved / along;
    if (met_curvature_ < -options_.flat * largest_) return TangentSolveStatus::falling;
    if (met_curvature_ <= options_.flat * largest_) return TangentSolveStatus::flat;
    const double step = square / curved;
    v += step * direction_;
    left_ -= step * curved_;
    manifold.project(state_.x, left_);
    keep_orthogonal(left_);
    const double next = inner(left_, left_);
    direction_ = left_ + next / square * direction_;
    square = next;
  }
  return TangentSolveStatus::iteration_limit;
}

TangentSolveStatus TangentSolver::solve(const Vector& b, Vector& v, double enough) {
  const TangentSolveStatus out = iterate(b, v, enough);
  residual_ = std::numeric_limits<double>::quiet_NaN();
  if (!v.allFinite()) return TangentSolveStatus::not_finite;
  if (v.isZero(0)) {
    residual_ = problem_.manifold().norm(state_.x, b);
    return out;
  }
  apply(v);
  left_ = b - curved_;
  residual_ = problem_.manifold().norm(state_.x, left_);
  return out;
}

TangentSolveStatus TangentSolver::least_curvature(double& curvature, Vector& direction) {
  direction = any_direction();
  curvature = largest_;
  if (problem_.manifold().dimension() == 0) return TangentSolveStatus::solved;
  Vector next;
  constexpr int few = 3;
  for (int k = 0; k < few; ++k) {
    const TangentSolveStatus status = solve(direction, next);
    if (status == TangentSolveStatus::flat || status == TangentSolveStatus::falling) {
      curvature = met_curvature_;
      direction = direction_ / problem_.manifold().norm(state_.x, direction_);
    }
    if (status != TangentSolveStatus::solved) return status;
    direction = next / problem_.manifold().norm(state_.x, next);
    apply(direction);
    curvature = std::min(curvature, inner(direction, curved_));
  }
  if (curvature < -options_.flat * largest_) return TangentSolveStatus::falling;
  return curvature <= options_.flat * largest_ ? TangentSolveStatus::flat : TangentSolveStatus::solved;
}

}  // namespace lagroid::optimisation
