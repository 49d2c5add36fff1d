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
#include <lagroid/solvers/lie_group/controlled_steps.hpp>
#include <lagroid/solvers/lie_group/embedded_step.hpp>
#include <lagroid/solvers/lie_group/step.hpp>
#include <lagroid/solvers/methods/method.hpp>
#include <lagroid/solvers/step/step_solver.hpp>

#include <utility>

namespace lagroid {

/// Equal steps. After each, rounding is kept from M (HomogeneousSpace::project), except by a classical method, which is
/// not on M to begin with.
template <HomogeneousSpace M, AlgebraField<M> F> class LieGroupIntegrator {
 public:
  using Point = typename M::Point;

  /// Throws std::invalid_argument for a start of another size than the points of M.
  LieGroupIntegrator(M space, F field, const LieGroupMethod& method, Point start, double h, double time = 0)
      : step_(std::move(space), method), field_(std::move(field)), point_(start), trial_(start), h_(h), start_(time) {
    detail::require_size(step_.space().zero_point(), point_);
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

/// Steps whose size follows the estimate of an embedded method: h <- h 0.9 (tolerance / error)^(1/order), changed by
/// factors of 0.2 to 5.
template <HomogeneousSpace M, AlgebraField<M> F>
class ControlledLieGroupIntegrator : public ControlledSteps<EmbeddedStep<M>, F> {
 public:
  using Point = typename M::Point;

  /// Throws std::invalid_argument for a method without an embedded one, control that is not positive, or a start of
  /// another size than the points of M.
  ControlledLieGroupIntegrator(M space, F field, const LieGroupMethod& method, Point start,
                               const LieGroupControl& control, double time = 0)
      : ControlledSteps<EmbeddedStep<M>, F>({std::move(space), method, control.tolerance}, std::move(field),
                                            std::move(start), control, time) {}
};

}  // namespace lagroid
