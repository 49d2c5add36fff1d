#pragma once
/// Steps of a size that each chooses for the next one, to whatever time is asked for.
///
///     ControlledSteps steps(EmbeddedStep<Spheres<1>>({}, lie_group_methods::munthe_kaas_54, 1e-10), field, start, {});
///     const StepReport report = steps.advance_to(2);
///
/// A step of one's own has `Point`, `zero_point()`, `traits()`,
///
///     StepAttempt attempt(F& field, double t, double h, const Point& z, Point& next)
///
/// and a `Memory` of what its next one goes on from beside the point: `keep`, `go_back_to`, `serialize`.
/// ControlledLieGroupIntegrator and ExtrapolationIntegrator are such.
///
/// Throws std::invalid_argument for control that is not positive, and for a start of another size than the points.

#include <lagroid/core/number_archive.hpp>
#include <lagroid/core/scalars/numbers_of.hpp>
#include <lagroid/solvers/methods/method.hpp>
#include <lagroid/solvers/step/step_solver.hpp>

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

namespace lagroid {

/// What has come of a step.
struct StepAttempt {
  bool accepted;
  bool finite;
  double next;      ///< the size to go on with, or to try again with
  int evaluations;  ///< of the field
};

/// How steps are controlled.
struct LieGroupControl {
  double tolerance = 1e-10;  ///< of the error over a step, its largest component
  double first_step = 1e-3;
  double largest_step = 1e300;
  long most_steps = 100'000'000;         ///< tried on the way to one end
  std::function<bool()> stop = nullptr;  ///< called before each; true ends the advance as a limit of steps does
  /// Called after each that is accepted, with its size and how often it evaluated the field.
  std::function<void(double h, int evaluations)> accepted = nullptr;
};

namespace detail {

/// The size of a step where so much is left to go: no crumb is left for the last one.
inline double step_on_the_way(double size, double left) {
  return size < left && left < 2 * size ? 0.5 * left : std::min(size, left);
}
/// The size to go on with, after a step of size `taken` that was to have `size`: one that was cut short to end where it
/// had to says nothing against longer ones.
inline double size_after(const StepAttempt& attempt, double taken, double size) {
  return attempt.accepted && taken < size ? std::max(size, attempt.next) : attempt.next;
}

template <class Point> void require_size(const Point& like, const Point& z) {
  if (z.rows() != like.rows() || z.cols() != like.cols())
    throw std::invalid_argument("the start of an integrator is a point of " + std::to_string(z.cols()) +
                                " columns, those of its space have " + std::to_string(like.cols()));
}

}  // namespace detail

template <class Step, class F> class ControlledSteps {
 public:
  using Point = typename Step::Point;

  ControlledSteps(Step step, F field, Point start, const LieGroupControl& control, double time = 0)
      : step_(std::move(step)),
        field_(std::move(field)),
        point_(start),
        trial_(start),
        control_(control),
        h_(control.first_step),
        time_(time) {
    detail::require_size(Point(step_.zero_point()), point_);
    if (!(control.tolerance > 0) || !(control.first_step > 0) || !(control.largest_step > 0))
      throw std::invalid_argument("tolerance and steps of a controlled integrator are positive");
  }

  const Point& point() const { return point_; }
  double time() const { return time_; }
  long steps() const { return steps_; }              ///< accepted so far
  long rejected() const { return rejected_; }        ///< tried in vain so far
  long evaluations() const { return evaluations_; }  ///< of the field, since it was made
  MethodTraits traits() const { return step_.traits(); }

  /// Steps until `end`, where the last ends exactly. `no_step`: the error stays above the tolerance however small the
  /// step; `not_finite`: so does a number that is not finite; `not_converged`: the limit of steps is reached. The point
  /// is the last one accepted. Throws std::invalid_argument for an end before the present time.
  StepReport advance_to(double end) {
    if (!(end >= time_)) throw std::invalid_argument("a controlled integrator goes on to a later time");
    StepReport report;
    const long before = steps_ + rejected_;
    while (time_ < end) {
      const double left = end - time_;
      const double h = detail::step_on_the_way(std::min(h_, control_.largest_step), left);
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
    typename Step::Memory memory;
    Point point;
    double h, time;
    long steps, rejected;
  };
  Place place() const {
    Place at;
    keep(at);
    return at;
  }
  void keep(Place& at) const {
    step_.keep(at.memory);
    at.point = point_;
    std::tie(at.h, at.time, at.steps, at.rejected) = std::tie(h_, time_, steps_, rejected_);
  }
  void go_back_to(const Place& at) {
    step_.go_back_to(at.memory);
    point_ = at.point;
    std::tie(h_, time_, steps_, rejected_) = std::tie(at.h, at.time, at.steps, at.rejected);
  }

 private:
  void try_step(double h, double reached) {
    const StepAttempt attempt = step_.attempt(field_, time_, h, point_, trial_);
    finite_ = attempt.finite;
    evaluations_ += attempt.evaluations;
    h_ = detail::size_after(attempt, h, h_);
    if (!attempt.accepted) {
      ++rejected_;
      return;
    }
    std::swap(point_, trial_);
    time_ = reached;
    ++steps_;
    if (control_.accepted) control_.accepted(h, attempt.evaluations);
  }

  Step step_;
  F field_;
  Point point_, trial_;
  LieGroupControl control_;
  double h_, time_;
  long steps_ = 0;
  long rejected_ = 0;
  long evaluations_ = 0;
  bool finite_ = true;
};

}  // namespace lagroid
