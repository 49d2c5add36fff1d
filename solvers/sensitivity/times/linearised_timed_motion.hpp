#pragma once
/// Motions whose steps vary, linearised: adaptive steps ([G] Example 6.1), whose size is an unknown with a derivative
/// of its own, and prescribed ones, h = epsilon sigma(g). States are those of the phase space extended by time and its
/// momentum, and steps solve, with nu = 0 where they are adaptive,
///
///     F-(g, lambda; h) - nu (dh)-(g) = mu,    F-_t(g, lambda; h) + nu = p_t,    phi(g; h) = 0,    t1 = t0 + h,
///
/// linearised at their solution as all others are. The first step has a given size, t1 - t0 = h, with nu = 0: it says
/// what p_t and epsilon are, p_t = F+_t and epsilon = h / sigma(g), so that both depend on the start.
///
///     LinearisedTimedMotion<Kepler, TimeMode::adaptive> motion(kepler, start, unit, {}, end_state);
///     const Propagated end = propagate_forward(motion, 100, directions);  // columns (v, mu, t, p_t, theta)
///
/// States are (v, mu, t, p_t), and epsilon after them where steps are prescribed; a start varies by the first two
/// alone. The matrix of each step but the first is symplectic on the extended phase space, at a given epsilon.
///
/// Adaptive steps may go on where the energy has no root, by steps of the first one's size (WithoutRoot::constant):
/// these have t1 - t0 = h too, and p_t as it is. Which steps they are is held.
///
/// Requires a Timed system that is not nonholonomic, with a `time_scale` of its arrows for prescribed steps. Errors:
/// std::invalid_argument for a name that is no parameter, and for WithoutRoot::controlled; WithoutDerivative for one
/// that is read as a plain number. A step without root is its status, unless it goes on.

#include <lagroid/groupoids/time_extended.hpp>
#include <lagroid/solvers/integrators/adaptive.hpp>
#include <lagroid/solvers/integrators/times/prescribed.hpp>
#include <lagroid/solvers/sensitivity/linearised_motion.hpp>
#include <lagroid/solvers/sensitivity/linearised_step.hpp>
#include <lagroid/solvers/sensitivity/times/timed_node.hpp>
#include <lagroid/solvers/sensitivity/varied_point.hpp>
#include <lagroid/solvers/step/newton_step.hpp>

#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace lagroid {

/// Whether runs of such steps have derivatives.
template <class Sys, TimeMode mode>
concept VaryingSteps = Timed<Sys> && !Nonholonomic<Sys> &&
                       (mode == TimeMode::adaptive || (mode == TimeMode::prescribed && HasTimeScaleOfArrows<Sys>));

namespace detail {

/// h(g) = epsilon sigma(g), epsilon varied as parameters are.
struct VariedTimeScale {
  double epsilon = 0;
  template <class Base, class A> auto operator()(const Base& base, const A& g) const {
    const auto scale = base.time_scale(g);
    return decltype(scale)(scale * varied<std::remove_const_t<decltype(scale)>>(epsilon));
  }
};

template <class Sys, TimeMode mode> struct TimedSteps;
template <class Sys> struct TimedSteps<Sys, TimeMode::adaptive> {
  using Extended = FreeTime<Sys>;
  using Integrating = AdaptiveIntegrator<Sys>;
  static Extended extended(const Sys& system) { return Extended(system); }
  static Integrating begun(const Sys& system, const State<typename Sys::GroupoidType>& start,
                           const ArrowOf<typename Sys::GroupoidType>& configuration, WithoutRoot without_root) {
    if (without_root == WithoutRoot::controlled)
      throw std::invalid_argument("steps that a control gives where the energy has no root have no derivative");
    return {system,
            start,
            configuration,
            std::make_unique<NewtonStep<Sys>>(),
            std::make_unique<NewtonStep<Extended>>(),
            {.without_root = without_root}};
  }
};
template <class Sys> struct TimedSteps<Sys, TimeMode::prescribed> {
  using Extended = PrescribedStep<Sys, VariedTimeScale>;
  using Integrating = PrescribedIntegrator<Sys>;
  static Extended extended(const Sys& system) { return Extended(system, {}); }
  static Integrating begun(const Sys& system, const State<typename Sys::GroupoidType>& start,
                           const ArrowOf<typename Sys::GroupoidType>& configuration, WithoutRoot) {
    return {system, start, configuration, std::make_unique<NewtonStep<Sys>>(),
            std::make_unique<NewtonStep<PrescribedStep<Sys, TimeScaleStep>>>()};
  }
};

}  // namespace detail

template <class Sys, TimeMode mode>
requires VaryingSteps<Sys, mode>
class LinearisedTimedMotion final : public LinearisedMotion {
 public:
  using G = typename Sys::GroupoidType;
  using Steps = detail::TimedSteps<Sys, mode>;
  using Extended = typename Steps::Extended;
  static constexpr int n = Sys::dimension;
  static constexpr bool prescribed = mode == TimeMode::prescribed;
  static constexpr int time_place = 2 * n;  ///< of t in a state
  static constexpr int size = 2 * n + 2 + (prescribed ? 1 : 0);

  LinearisedTimedMotion(const Sys& system, const State<G>& start, const ArrowOf<G>& configuration,
                        const std::vector<std::string>& parameters, ObserveTimedNode<Sys> observe,
                        WithoutRoot without_root = WithoutRoot::stop)
      : integrator_(Steps::begun(system, start, configuration, without_root)),
        in_part_(system, std::make_unique<NewtonStep<Sys>>()),
        extended_(Steps::extended(system)),
        places_(places_of_parameters(extended_.base, parameters)),
        members_(places_.members),
        observe_(std::move(observe)),
        stage_(equations, size, int(places_.members.size())) {
    if constexpr (prescribed) members_.push_back(&extended_.step_size.epsilon);
    extended_step_ = LinearStep(equations, 2 * Extended::dimension, int(members_.size()));
  }
  LinearisedTimedMotion(const LinearisedTimedMotion&) = delete;  // derivatives know members by their places
  LinearisedTimedMotion& operator=(const LinearisedTimedMotion&) = delete;

  int states() const override { return size; }
  int parameters() const override { return int(places_.members.size()); }
  const std::vector<std::string>& parameter_names() const { return places_.names; }
  const TrajectoryPoint<Sys>& point() const { return integrator_.point(); }
  double time() const override { return point().time; }
  bool has_equal_steps() const override { return false; }
  StepReport advance() override {
    const long before = without_root();
    const StepReport report = integrator_.advance();
    has_root_ = without_root() == before;
    return report;
  }
  /// Steps so far whose energy had no root.
  long without_root() const {
    if constexpr (prescribed) {
      return 0;
    } else {
      return integrator_.without_root();
    }
  }

  bool linearise() override {
    const double h = point().step_size;
    extended_.origin = point().time - h;
    const Step<Extended> step = last_step();
    linearise_step(extended_, step, members_, extended_step_);
    if (!std::exchange(compared_, true)) detail::compare_with_differences(extended_, places_, step, extended_step_);
    Eigen::RowVectorXd epsilon_by_unknowns = Eigen::RowVectorXd::Zero(equations);
    Eigen::RowVectorXd epsilon_by_start = Eigen::RowVectorXd::Zero(extended_step_.equations_by_start.cols());
    if constexpr (prescribed) {
      const int last = int(epsilon_by_start.size()) - 1;
      if (point().index == 1) {
        // d(t1 - t0) - epsilon dsigma = sigma depsilon
        const double scale = h / extended_.step_size.epsilon;
        epsilon_by_unknowns = extended_step_.equations_by_unknowns.row(step_equation) / scale;
        epsilon_by_start = extended_step_.equations_by_start.row(step_equation) / scale;
      }
      epsilon_by_start(last) = point().index == 1 ? 0 : 1;
    }
    if (point().index == 1)
      begin_with_size();
    else if (!has_root_)
      give_size();
    arrange(epsilon_by_unknowns, epsilon_by_start);
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
    linearise_step(extended_, extended_step(to->step, time - point().time, 0), members_, extended_step_);
    give_size();
    // It ends at this time, whenever it began.
    extended_step_.equations_by_start.row(time_equation).setZero();
    const Eigen::RowVectorXd none = Eigen::RowVectorXd::Zero(extended_step_.equations_by_start.cols());
    arrange(Eigen::RowVectorXd::Zero(equations), none);
    if (!stage_.factor()) return std::nullopt;
    return detail::before_step(detail::observe_timed(extended_.base, places_, *to, size, observe_), stage_);
  }

  void serialize(NumberArchive& archive) override { integrator_.serialize(archive); }

 private:
  static constexpr int equations = Extended::dimension + Extended::constraints;
  /// Of extended states (t, v, p_t, mu).
  static constexpr int extended_time = 0;
  static constexpr int extended_time_momentum = n + 1;
  /// The equation of time, and of prescribed steps that of their size; its multiplier has the same place.
  static constexpr int time_equation = 0;
  static constexpr int step_equation = Extended::dimension + Sys::arrow_constraints;

  Step<Extended> last_step() {
    const double multiplier = [&] {
      if constexpr (prescribed) {
        if (point().index > 1) return integrator_.step_multiplier();
      }
      return 0.0;
    }();
    return extended_step(point().step, point().step_size, multiplier);
  }
  /// The same step of the extended system, with the multiplier of its size.
  Step<Extended> extended_step(const Step<Sys>& step, double step_size, [[maybe_unused]] double multiplier) {
    const PairArrow<double, 1> times{Vector<double, 1>(0.0), Vector<double, 1>(step_size)};
    if constexpr (prescribed) {
      extended_.step_size.epsilon = step_size / extended_.base.time_scale(step.arrow);
      typename Extended::Multipliers multipliers;
      multipliers << step.multipliers.template head<Sys::arrow_constraints>(), multiplier,
          step.multipliers.template tail<Sys::object_constraints>();
      return {{times, step.arrow}, multipliers};
    } else {
      return {{times, step.arrow}, step.multipliers};
    }
  }
  /// Of a given size, and p_t = F+_t, which is p_t + (F+ - F-)_t and what the equation of time is short of.
  void begin_with_size() {
    LinearStep& step = extended_step_;
    step.end_by_unknowns.row(extended_time_momentum) += step.equations_by_unknowns.row(time_equation);
    step.end_by_start.row(extended_time_momentum) += step.equations_by_start.row(time_equation);
    give_size();
  }
  /// t1 - t0 = h and nu = 0 in place of the equations of time and size.
  void give_size() {
    LinearStep& step = extended_step_;
    const auto clear = [&](int equation) {
      step.equations_by_unknowns.row(equation).setZero();
      step.equations_by_start.row(equation).setZero();
    };
    clear(time_equation);
    step.equations_by_unknowns(time_equation, extended_time) = 1;
    step.equations_by_start(time_equation, extended_time) = -1;
    if constexpr (prescribed) {
      clear(step_equation);
      step.equations_by_unknowns(step_equation, step_equation) = 1;
    }
  }
  /// From (t, v, p_t, mu, theta, epsilon) to (v, mu, t, p_t, epsilon, theta).
  void arrange(const Eigen::RowVectorXd& epsilon_by_unknowns, const Eigen::RowVectorXd& epsilon_by_start) {
    const int of_parameters = 2 * Extended::dimension;
    const auto place = [&](int k) {
      if (k < n) return 1 + k;
      if (k < 2 * n) return 2 + k;
      if (k == time_place) return extended_time;
      if (k == time_place + 1) return extended_time_momentum;
      if (k < size) return of_parameters + parameters();
      return of_parameters + k - size;
    };
    stage_.equations_by_unknowns = extended_step_.equations_by_unknowns;
    for (int row = 0; row < 2 * n + 2; ++row)
      stage_.end_by_unknowns.row(row) = extended_step_.end_by_unknowns.row(place(row));
    if constexpr (prescribed) stage_.end_by_unknowns.row(size - 1) = epsilon_by_unknowns;
    for (int k = 0; k < size + parameters(); ++k) {
      stage_.equations_by_start.col(k) = extended_step_.equations_by_start.col(place(k));
      for (int row = 0; row < 2 * n + 2; ++row)
        stage_.end_by_start(row, k) = extended_step_.end_by_start(place(row), place(k));
      if constexpr (prescribed) stage_.end_by_start(size - 1, k) = epsilon_by_start(place(k));
    }
  }

  typename Steps::Integrating integrator_;
  detail::StepInPart<Sys> in_part_;
  Extended extended_;
  ParameterPlaces places_;
  std::vector<const double*> members_;
  ObserveTimedNode<Sys> observe_;
  LinearStep extended_step_{0, 0, 0};  ///< of (t, v, p_t, mu), theta and epsilon
  LinearStep stage_;
  bool has_root_ = true;  ///< the last step
  bool compared_ = false;
};

}  // namespace lagroid
