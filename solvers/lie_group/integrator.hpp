#pragma once
/// Lie group integrators for z' = F(t, z)_M(z): with equal steps, and with steps that an error estimate controls,
///
///     h <- 0.9 h (tolerance / error)^(1 / order).
///
/// They integrate motions on spheres and other homogeneous spaces that are not those of a discrete Lagrangian.
///
///     const auto spin = [](double, const auto&, auto& out) { out.setConstant(1); };  // an element of the algebra
///     LieGroupIntegrator integrator(Spheres<1>{}, spin, lie_group_methods::commutator_free_4,
///                                   Spheres<1>::Point(0, 0, 1), 0.01);  // h
///     const StepReport report = integrator.advance();
///
/// Requires a start on M of the size of its points, and for control a method that has an embedded one
/// (std::invalid_argument otherwise). Status: `not_finite`; with control also `no_step` (the error stays too large) and
/// `not_converged` (limit of steps). The point is then the last one accepted.

#include <lagroid/core/number_archive.hpp>
#include <lagroid/solvers/lie_group/step.hpp>
#include <lagroid/solvers/methods/method.hpp>
#include <lagroid/solvers/step/step_solver.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

namespace lagroid {

/// What a method declares of itself.
inline MethodTraits traits_of(const LieGroupMethod& method) {
  return {std::string(method.name), method.order, false, false, true, method.stages - (method.reuses_last ? 1 : 0)};
}

namespace detail {

template <HomogeneousSpace M> void require_size(const M& space, const typename M::Point& z) {
  const typename M::Point like = space.zero_point();
  if (z.rows() != like.rows() || z.cols() != like.cols())
    throw std::invalid_argument("the start of an integrator is a point of " + std::to_string(z.cols()) +
                                " columns, those of its space have " + std::to_string(like.cols()));
}

}  // namespace detail

/// Equal steps. After each, rounding is kept from M (HomogeneousSpace::project), except by a classical method, which is
/// not on M to begin with.
template <HomogeneousSpace M, AlgebraField<M> F> class LieGroupIntegrator {
 public:
  using Point = typename M::Point;

  /// Throws std::invalid_argument for a start of another size than the points of M.
  LieGroupIntegrator(M space, F field, const LieGroupMethod& method, Point start, double h, double time = 0)
      : step_(std::move(space), method), field_(std::move(field)), point_(start), trial_(start), h_(h), start_(time) {
    detail::require_size(step_.space(), point_);
  }

  const Point& point() const { return point_; }
  double time() const { return start_ + double(index_) * h_; }
  long index() const { return index_; }
  MethodTraits traits() const { return traits_of(step_.method()); }

  /// `converged`, or `not_finite`, which leaves everything as it was.
  StepReport advance() {
    trial_ = point_;
    step_.advance(field_, time(), h_, trial_);
    StepReport report;
    report.status = SolveStatus::not_finite;
    if (!trial_.allFinite()) {
      step_.forget();
      return report;
    }
    if (step_.method().scheme != LieGroupScheme::classical) step_.space().project(trial_);
    std::swap(point_, trial_);
    ++index_;
    report.status = SolveStatus::converged;
    return report;
  }

  /// Visits all that the next step goes on from, to its last bit.
  void serialize(NumberArchive& archive) {
    auto point = numbers_of(point_);
    archive(point, index_, step_);
  }

 private:
  LieGroupStep<M> step_;
  F field_;
  Point point_, trial_;
  double h_, start_;
  long index_ = 0;
};

/// How steps are controlled.
struct LieGroupControl {
  double tolerance = 1e-10;  ///< of an embedded method's error over a step, in the algebra
  double first_step = 1e-3;
  double largest_step = 1e300;
  long most_steps = 100'000'000;         ///< tried on the way to one end
  std::function<bool()> stop = nullptr;  ///< called before each; true ends the advance as a limit of steps does
};

/// Steps whose size follows the estimate of an embedded method: h <- h 0.9 (tolerance / error)^(1/order), changed by
/// factors of 0.2 to 5.
template <HomogeneousSpace M, AlgebraField<M> F> class ControlledLieGroupIntegrator {
 public:
  using Point = typename M::Point;

  /// Throws std::invalid_argument for a method without an embedded one, control that is not positive, or a start of
  /// another size than the points of M.
  ControlledLieGroupIntegrator(M space, F field, const LieGroupMethod& method, Point start,
                               const LieGroupControl& control, double time = 0)
      : step_(std::move(space), method),
        field_(std::move(field)),
        point_(start),
        trial_(start),
        control_(control),
        h_(control.first_step),
        time_(time) {
    detail::require_size(step_.space(), point_);
    if (!method.embedded()) throw std::invalid_argument(std::string(method.name) + " estimates no error");
    if (!(control.tolerance > 0) || !(control.first_step > 0) || !(control.largest_step > 0))
      throw std::invalid_argument("tolerance and steps of a controlled integrator are positive");
  }

  const Point& point() const { return point_; }
  double time() const { return time_; }
  long steps() const { return steps_; }        ///< accepted so far
  long rejected() const { return rejected_; }  ///< tried in vain so far
  MethodTraits traits() const { return traits_of(step_.method()); }

  /// Steps until `end`, where the last ends exactly. `no_step`: the error stays above the tolerance however small the
  /// step; `not_finite`: so does a number that is not finite; `not_converged`: the limit of steps is reached. The point
  /// is the last one accepted. Throws std::invalid_argument for an end before the present time.
  StepReport advance_to(double end) {
    if (!(end >= time_)) throw std::invalid_argument("a controlled integrator goes on to a later time");
    StepReport report;
    const long before = steps_ + rejected_;
    while (time_ < end) {
      const double left = end - time_;
      double h = std::min({h_, left, control_.largest_step});
      // No crumb is left for the last step.
      if (h < left && left < 2 * h) h = 0.5 * left;
      const bool too_many = steps_ + rejected_ - before >= control_.most_steps || (control_.stop && control_.stop());
      if (!(time_ + h > time_) || too_many) {
        report.status = too_many  ? SolveStatus::not_converged
                        : finite_ ? SolveStatus::no_step
                                  : SolveStatus::not_finite;
        return report;
      }
      try_step(h, h == left ? end : time_ + h);
    }
    report.status = SolveStatus::converged;
    return report;
  }
  /// Visits all that the next step goes on from, to its last bit.
  void serialize(NumberArchive& archive) {
    auto point = numbers_of(point_);
    archive(point, h_, time_, steps_, rejected_, step_);
  }
  /// The same, to be gone back to. Nothing is allocated where a place of this integrator is overwritten.
  struct Place {
    LieGroupStep<M> step;
    Point point;
    double h, time;
    long steps, rejected;
  };
  Place place() const { return {step_, point_, h_, time_, steps_, rejected_}; }
  void keep(Place& at) const {
    at.step = step_;
    at.point = point_;
    std::tie(at.h, at.time, at.steps, at.rejected) = std::tie(h_, time_, steps_, rejected_);
  }
  void go_back_to(const Place& at) {
    step_ = at.step;
    point_ = at.point;
    std::tie(h_, time_, steps_, rejected_) = std::tie(at.h, at.time, at.steps, at.rejected);
  }

 private:
  void try_step(double h, double reached) {
    trial_ = point_;
    step_.advance(field_, time_, h, trial_);
    const double error = step_.error();
    finite_ = trial_.allFinite() && std::isfinite(error);
    if (!finite_) {
      step_.forget();
      h_ = 0.2 * h;
      ++rejected_;
      return;
    }
    const double factor =
        std::clamp(0.9 * std::pow(control_.tolerance / std::max(error, 1e-300), 1.0 / step_.method().order), 0.2, 5.0);
    if (error > control_.tolerance) {
      step_.reject();
      h_ = h * factor;
      ++rejected_;
      return;
    }
    step_.space().project(trial_);
    std::swap(point_, trial_);
    time_ = reached;
    h_ = h < h_ ? std::max(h_, h * factor) : h * factor;
    ++steps_;
  }

  LieGroupStep<M> step_;
  F field_;
  Point point_, trial_;
  LieGroupControl control_;
  double h_, time_;
  long steps_ = 0;
  long rejected_ = 0;
  bool finite_ = true;
};

}  // namespace lagroid
