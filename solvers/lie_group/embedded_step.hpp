#pragma once
/// A step that says by an embedded method how large its error is, for ControlledSteps: h <- 0.9 h (tolerance /
/// error)^(1/order), changed by factors of 0.2 to 5.
///
///     EmbeddedStep<Spheres<1>> step({}, lie_group_methods::munthe_kaas_54, 1e-10);  // tolerance
///     const StepAttempt attempt = step.attempt(field, 0, 0.1, z, next);             // t, h; `next` where accepted
///
/// Throws std::invalid_argument for a method without an embedded one.

#include <lagroid/core/hamiltonian/homogeneous_space.hpp>
#include <lagroid/core/number_archive.hpp>
#include <lagroid/solvers/lie_group/controlled_steps.hpp>
#include <lagroid/solvers/lie_group/step.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace lagroid {

template <HomogeneousSpace M> class EmbeddedStep {
 public:
  using Point = typename M::Point;
  using Memory = typename LieGroupStep<M>::Memory;

  EmbeddedStep(M space, const LieGroupMethod& method, double tolerance)
      : step_(std::move(space), method), tolerance_(tolerance) {
    if (!method.embedded()) throw std::invalid_argument(std::string(method.name) + " estimates no error");
  }

  Point zero_point() const { return step_.space().zero_point(); }
  MethodTraits traits() const { return traits_of(step_.method()); }

  template <AlgebraField<M> F> StepAttempt attempt(F& field, double t, double h, const Point& z, Point& next) {
    const LieGroupMethod& method = step_.method();
    const int evaluations = method.stages - (method.reuses_last ? 1 : 0);
    next = z;
    step_.advance(field, t, h, next);
    const double error = step_.error();
    if (!next.allFinite() || !std::isfinite(error)) {
      step_.forget();
      return {false, false, 0.2 * h, evaluations};
    }
    const double factor =
        std::clamp(0.9 * std::pow(tolerance_ / std::max(error, 1e-300), 1.0 / method.order), 0.2, 5.0);
    const bool accepted = error <= tolerance_;
    if (accepted) {
      step_.space().project(next);
    } else {
      step_.reject();
    }
    return {accepted, true, h * factor, evaluations};
  }

  void serialize(NumberArchive& archive) { archive(step_); }
  void keep(Memory& at) const { step_.keep(at); }
  void go_back_to(const Memory& at) { step_.go_back_to(at); }

 private:
  LieGroupStep<M> step_;
  double tolerance_;
};

}  // namespace lagroid
