#pragma once
/// The motion of a system by an integrator, its steps linearised: implicit steps of any kind, one after another or
/// composed to higher order, each stage by the equations that hold at its solution.
///
///     LinearisedMotionOf<Pendulum> motion(pendulum, std::move(integrator), {"mass", "length"}, end_state);
///     const Propagated end = propagate_forward(motion, 100, directions);
///
/// Requires an integrator of equal, implicit steps at its start, made of an equal system. What is observed is a
/// function of an ObservedNode over VariedNumber.
///
/// Errors: std::invalid_argument, one line, for a name that is no parameter, for steps in closed form and for those
/// whose sizes vary. WithoutDerivative where a parameter is read by the system as a plain number, found at the first
/// step by comparison with differences.

#include <lagroid/solvers/integrators/integrator.hpp>
#include <lagroid/solvers/sensitivity/linearised_motion.hpp>
#include <lagroid/solvers/sensitivity/linearised_step.hpp>
#include <lagroid/solvers/sensitivity/varied_point.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

/// What can be observed of a node; the momentum is the one that is reported (tangent_momentum). The system is that of
/// the run, whose members a function reads by `varied`.
template <class Sys> struct ObservedNode {
  using G = typename Sys::GroupoidType;
  const Sys& system;
  double time;
  ObjectOf<G, VariedNumber> object;
  AlgebroidVector<G, VariedNumber> momentum;
  ArrowOf<G, VariedNumber> configuration;
};
/// Functions of a node.
template <class Sys> using ObserveNode = std::function<VariedVector(const ObservedNode<Sys>&)>;

template <DiscreteSystem Sys> class LinearisedMotionOf final : public LinearisedMotion {
 public:
  using G = typename Sys::GroupoidType;
  static constexpr int n = Sys::dimension;
  static constexpr int m = Sys::constraints;

  LinearisedMotionOf(const Sys& system, std::unique_ptr<Integrator<Sys>> integrator,
                     const std::vector<std::string>& parameters, ObserveNode<Sys> observe)
      : system_(system),
        integrator_(std::move(integrator)),
        places_(places_of_parameters(system_, parameters)),
        observe_(std::move(observe)),
        comparisons_(places_.members.size()) {
    if (integrator_->traits().explicit_)
      throw std::invalid_argument("steps in closed form have no derivative here: take implicit steps");
  }
  LinearisedMotionOf(const LinearisedMotionOf&) = delete;  // derivatives know members by their places
  LinearisedMotionOf& operator=(const LinearisedMotionOf&) = delete;

  int states() const override { return 2 * n; }
  int parameters() const override { return int(places_.members.size()); }
  const std::vector<std::string>& parameter_names() const { return places_.names; }
  const TrajectoryPoint<Sys>& point() const { return integrator_->point(); }
  Integrator<Sys>& integrator() { return *integrator_; }
  Sys& system() { return system_; }
  /// Of its parameters.
  Comparisons& comparisons() { return comparisons_; }
  double time() const override { return point().time; }
  StepReport advance() override { return integrator_->advance(); }

  bool linearise() override {
    used_ = 0;
    bool finite = true;
    double duration = 0;
    const auto stage = [&](const Step<Sys>& step, double start, double size) {
      if (used_ == stages_.size()) stages_.emplace_back(n + m, 2 * n, parameters());
      set_time_step(system_, size);
      set_time(system_, start);
      linearise_step(system_, step, places_.members, stages_[used_]);
      comparisons_.take(
          [&](std::size_t j) { detail::compare_with_differences(system_, places_, j, step, stages_[used_]); });
      finite = stages_[used_].factor() && finite;
      duration += size;
      ++used_;
    };
    integrator_->for_each_inner_stage(std::ref(stage));  // no memory of its own
    stage(point().step, point().time - point().step_size, point().step_size);
    if (step_size_ == 0) step_size_ = duration;  // zero of a system without a step
    if (std::abs(duration - step_size_) > 1e-9 * std::abs(step_size_))
      throw std::invalid_argument("steps whose sizes vary have no derivative here: take equal steps");
    return finite;
  }
  int stages() const override { return int(used_); }
  const LinearStep& stage(int k) const override { return stages_[std::size_t(k)]; }

  NodeValues observe() const override {
    return detail::values_at(system_, places_, point(), 0,
                             [&](int, const auto& object, const auto& momentum, const auto& configuration) {
                               return observe_({system_, point().time, object, momentum, configuration});
                             });
  }

  void serialize(NumberArchive& archive) override { integrator_->serialize(archive); }

 private:
  Sys system_;
  std::unique_ptr<Integrator<Sys>> integrator_;
  ParameterPlaces places_;
  ObserveNode<Sys> observe_;
  std::vector<LinearStep> stages_;
  std::size_t used_ = 0;
  double step_size_ = 0;  ///< of the first step
  Comparisons comparisons_;
};

}  // namespace lagroid
