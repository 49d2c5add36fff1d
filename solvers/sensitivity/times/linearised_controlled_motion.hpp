#pragma once
/// Motions by controlled steps (step_control.hpp), linearised: a step of size h = epsilon / rho and the density that it
/// leads to,
///
///     (v, mu, t, rho) -> (v', mu', t + h, rho'),    rho' = rho - epsilon r(z'),    r = d log sigma / dt,
///
/// whose derivatives are those of the step, by its size too, and of r. The first density is that of the start,
/// rho = 1 - epsilon r(z_0) / 2, epsilon being the first step, which derivatives hold.
///
///     LinearisedControlledMotion<Kepler> motion(kepler, start, unit, {"strength"}, end_state);
///     const Propagated end = propagate_forward(motion, 100, directions);  // columns (v, mu, t, rho, theta)
///
/// A start varies by (v, mu) alone. The matrix is not symplectic, as such steps are not.
///
/// Requires a Timed system that is not nonholonomic and has its `time_scale_rate` as a template on the scalar, of
/// object and momentum. Errors: std::invalid_argument for a name that is no parameter; WithoutDerivative for one that
/// is read as a plain number. Where the controller has no step, or a step no root, that is its status.

#include <lagroid/groupoids/time_extended.hpp>
#include <lagroid/solvers/integrators/step_control.hpp>
#include <lagroid/solvers/sensitivity/linearised_motion.hpp>
#include <lagroid/solvers/sensitivity/linearised_step.hpp>
#include <lagroid/solvers/sensitivity/times/timed_node.hpp>
#include <lagroid/solvers/sensitivity/varied_point.hpp>
#include <lagroid/solvers/step/newton_step.hpp>

#include <concepts>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

/// Whether controlled runs have derivatives.
template <class Sys>
concept VariedTimeScale = Timed<Sys> && HasTimeScale<Sys> && !Nonholonomic<Sys> &&
                          requires(const Sys& system, const ObjectOf<typename Sys::GroupoidType, VariedNumber>& object,
                                   const AlgebroidVector<typename Sys::GroupoidType, VariedNumber>& momentum) {
  { system.time_scale_rate(object, momentum) } -> std::same_as<VariedNumber>;
};

template <VariedTimeScale Sys> class LinearisedControlledMotion final : public LinearisedMotion {
 public:
  using G = typename Sys::GroupoidType;
  using Extended = FreeTime<Sys>;
  static constexpr int n = Sys::dimension;
  static constexpr int time_place = 2 * n;  ///< of t in a state
  static constexpr int density_place = 2 * n + 1;
  static constexpr int size = 2 * n + 2;

  LinearisedControlledMotion(const Sys& system, const State<G>& start, const ArrowOf<G>& configuration,
                             const std::vector<std::string>& parameters, ObserveTimedNode<Sys> observe)
      : integrator_(system, start, configuration, std::make_unique<NewtonStep<Sys>>()),
        in_part_(system, std::make_unique<NewtonStep<Sys>>()),
        extended_(system),
        places_(places_of_parameters(extended_.base, parameters)),
        observe_(std::move(observe)),
        first_step_(system.h),
        rate_at_start_(rate_at(integrator_.point())),
        extended_step_(equations, 2 * Extended::dimension, int(places_.members.size())),
        stage_(equations, size, int(places_.members.size())) {}
  LinearisedControlledMotion(const LinearisedControlledMotion&) = delete;  // derivatives know members by their places
  LinearisedControlledMotion& operator=(const LinearisedControlledMotion&) = delete;

  int states() const override { return size; }
  int parameters() const override { return int(places_.members.size()); }
  const std::vector<std::string>& parameter_names() const { return places_.names; }
  const TrajectoryPoint<Sys>& point() const { return integrator_.point(); }
  double time() const override { return point().time; }
  bool has_equal_steps() const override { return false; }
  StepReport advance() override { return integrator_.advance(); }

  bool linearise() override {
    const double h = point().step_size;
    extended_.origin = point().time - h;
    const Step<Extended> step = extended_step(point().step, h);
    linearise_step(extended_, step, places_.members, extended_step_);
    if (!std::exchange(compared_, true)) detail::compare_with_differences(extended_, places_, step, extended_step_);
    arrange();
    // t1 - t0 = epsilon / rho, and rho = epsilon / h.
    stage_.equations_by_start(time_equation, density_place) = h * h / first_step_;
    const Eigen::RowVectorXd rate = rate_at(point());
    auto by_unknowns = stage_.end_by_unknowns.row(density_place);
    auto by_start = stage_.end_by_start.row(density_place);
    by_unknowns = -first_step_ * rate.head(2 * n) * stage_.end_by_unknowns.topRows(2 * n);
    by_start = -first_step_ * rate.head(2 * n) * stage_.end_by_start.topRows(2 * n);
    by_start.tail(parameters()) -= first_step_ * rate.tail(parameters());
    by_start(density_place) += 1;
    if (point().index == 1) begin_with_density_of_start();
    return stage_.factor();
  }
  int stages() const override { return 1; }
  const LinearStep& stage(int) const override { return stage_; }

  NodeValues observe() const override {
    return detail::observe_timed(extended_.base, places_, point(), size, observe_);
  }
  std::optional<NodeValues> observe_later(double time) override {
    const auto to = in_part_.from(point(), time);
    if (!to) return std::nullopt;
    extended_.origin = point().time;
    linearise_step(extended_, extended_step(to->step, time - point().time), places_.members, extended_step_);
    arrange();
    // It ends at this time, whenever it began.
    stage_.equations_by_start.row(time_equation).setZero();
    if (!stage_.factor()) return std::nullopt;
    return detail::before_step(detail::observe_timed(extended_.base, places_, *to, size, observe_), stage_);
  }

  void serialize(NumberArchive& archive) override { integrator_.serialize(archive); }

 private:
  static constexpr int equations = Extended::dimension + Extended::constraints;
  static constexpr int time_equation = 0;
  /// Of extended states (t, v, p_t, mu): p_t is no part of a step whose size is given.
  static int place_in_extended(int k) {
    if (k < n) return 1 + k;
    if (k < 2 * n) return 2 + k;
    return k == time_place ? 0 : 2 * Extended::dimension + k - size;
  }

  static Step<Extended> extended_step(const Step<Sys>& step, double step_size) {
    const PairArrow<double, 1> times{Vector<double, 1>(0.0), Vector<double, 1>(step_size)};
    return {{times, step.arrow}, step.multipliers};
  }
  /// The derivatives of the rate at a point by (v, mu, theta).
  Eigen::RowVectorXd rate_at(const TrajectoryPoint<Sys>& point) const {
    return detail::values_at(extended_.base, places_, point, 0,
                             [&](int, const auto& object, const auto& momentum, const auto&) {
                               return VariedVector::Constant(1, extended_.base.time_scale_rate(object, momentum));
                             })
        .derivatives;
  }
  /// From (t, v, p_t, mu, theta) to (v, mu, t, rho, theta), with t1 - t0 = h in place of the equation of time.
  void arrange() {
    extended_step_.equations_by_unknowns.row(time_equation).setZero();
    extended_step_.equations_by_start.row(time_equation).setZero();
    extended_step_.equations_by_unknowns(time_equation, 0) = 1;
    extended_step_.equations_by_start(time_equation, 0) = -1;
    stage_.equations_by_unknowns = extended_step_.equations_by_unknowns;
    stage_.end_by_unknowns.setZero();
    stage_.end_by_start.setZero();
    for (int row = 0; row <= time_place; ++row)
      stage_.end_by_unknowns.row(row) = extended_step_.end_by_unknowns.row(place_in_extended(row));
    for (int k = 0; k < size + parameters(); ++k) {
      stage_.equations_by_start.col(k).setZero();
      if (k == density_place) continue;
      stage_.equations_by_start.col(k) = extended_step_.equations_by_start.col(place_in_extended(k));
      for (int row = 0; row <= time_place; ++row)
        stage_.end_by_start(row, k) = extended_step_.end_by_start(place_in_extended(row), place_in_extended(k));
    }
  }
  /// rho = 1 - epsilon r(z_0) / 2 is no number of its own there.
  void begin_with_density_of_start() {
    Eigen::RowVectorXd by = Eigen::RowVectorXd::Zero(size + parameters());
    by.head(2 * n) = -0.5 * first_step_ * rate_at_start_.head(2 * n);
    by.tail(parameters()) = -0.5 * first_step_ * rate_at_start_.tail(parameters());
    for (Eigen::MatrixXd* each : {&stage_.equations_by_start, &stage_.end_by_start}) {
      const Eigen::VectorXd by_density = each->col(density_place);
      each->col(density_place).setZero();
      *each += by_density * by;
    }
  }

  ControlledIntegrator<Sys> integrator_;
  detail::StepInPart<Sys> in_part_;
  Extended extended_;
  ParameterPlaces places_;
  ObserveTimedNode<Sys> observe_;
  double first_step_;
  Eigen::RowVectorXd rate_at_start_;
  LinearStep extended_step_;  ///< of (t, v, p_t, mu) and theta
  LinearStep stage_;
  bool compared_ = false;
};

}  // namespace lagroid
