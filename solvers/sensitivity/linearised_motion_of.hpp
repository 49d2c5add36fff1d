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
#include <lagroid/solvers/sensitivity/varied_momentum.hpp>
#include <lagroid/solvers/sensitivity/varied_parameters.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

/// A parameter that a system reads as a plain number somewhere, so that its derivatives would be wrong.
class WithoutDerivative : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

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
using VariedVector = Eigen::Matrix<VariedNumber, Eigen::Dynamic, 1>;
template <class Sys> using ObserveNode = std::function<VariedVector(const ObservedNode<Sys>&)>;

namespace detail {

/// Throws WithoutDerivative unless derivatives by a member are near its differences: `coarse` and `fine`, of twice the
/// width of the fine ones.
void require_derivative(const std::string& name, const Eigen::VectorXd& derivative, const Eigen::VectorXd& coarse,
                        const Eigen::VectorXd& fine, double rounding);

}  // namespace detail

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
        observe_(std::move(observe)) {
    if (integrator_->traits().explicit_)
      throw std::invalid_argument("steps in closed form have no derivative here: take implicit steps");
  }
  LinearisedMotionOf(const LinearisedMotionOf&) = delete;  // derivatives know members by their places
  LinearisedMotionOf& operator=(const LinearisedMotionOf&) = delete;

  int states() const override { return 2 * n; }
  int parameters() const override { return int(places_.members.size()); }
  const std::vector<std::string>& parameter_names() const { return places_.names; }
  const TrajectoryPoint<Sys>& point() const { return integrator_->point(); }
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
      if (!std::exchange(compared_, true)) compare(step, stages_[used_]);
      finite = stages_[used_].factor() && finite;
      duration += size;
      ++used_;
    };
    integrator_->for_each_inner_stage(stage);
    stage(point().step, point().time - point().step_size, point().step_size);
    if (step_size_ == 0) step_size_ = duration;  // zero of a system without a step
    if (std::abs(duration - step_size_) > 1e-9 * std::abs(step_size_))
      throw std::invalid_argument("steps whose sizes vary have no derivative here: take equal steps");
    return finite;
  }
  int stages() const override { return int(used_); }
  const LinearStep& stage(int k) const override { return stages_[std::size_t(k)]; }

  NodeValues observe() const override {
    using V = VariedNumber;
    NodeValues out;
    const int count = 2 * n + parameters();
    const G& groupoid = system_.groupoid;
    const Vector<double, n> zero = Vector<double, n>::Zero();
    detail::for_directions(count, [&](int first) {
      const VariedMembers varying(places_.members, 2 * n - first);
      const Vector<V, n> v = detail::varied_along(zero, -first);
      const auto moved = groupoid.tau(groupoid.template cast_object<V>(point().state.object), v);
      const Vector<V, n> momentum = detail::varied_along(point().state.momentum, n - first);
      const ObjectOf<G, V> object = groupoid.target(moved);
      const VariedVector here =
          observe_({system_, point().time, object, varied_tangent_momentum(system_, object, momentum),
                    groupoid.compose(groupoid.template cast<V>(point().configuration), moved)});
      if (out.values.size() == 0) {
        out.values.resize(here.size());
        out.derivatives.resize(here.size(), count);
      }
      for (Eigen::Index i = 0; i < here.size(); ++i) {
        out.values(i) = here(i).value;
        for (int k = first; k < std::min(count, first + varied_at_once); ++k)
          out.derivatives(i, k) = here(i).tangent(k - first);
      }
    });
    return out;
  }

  std::vector<double> save() override {
    NumberArchive archive;
    integrator_->serialize(archive);
    return archive.numbers();
  }
  void restore(const std::vector<double>& saved) override {
    NumberArchive archive(saved);
    integrator_->serialize(archive);
  }

 private:
  /// The derivatives of the step equations by each parameter, beside differences of what a step computes.
  void compare(const Step<Sys>& step, const LinearStep& linear) {
    const auto at = [&](double& member, double value) {
      const double kept = std::exchange(member, value);
      const GradientsOf<Sys> d = gradients(system_, step.arrow, step.multipliers);
      member = kept;
      Eigen::VectorXd all(2 * n + m);
      all << -d.source_gradient, d.constraint, d.source_gradient + d.target_gradient;
      return all;
    };
    for (int j = 0; j < parameters(); ++j) {
      auto& member = const_cast<double&>(*places_.members[std::size_t(j)]);  // of system_, which is no constant
      const double here = member;
      const double width = 1e-4 * (here == 0 ? 1 : std::abs(here));
      const auto difference = [&](double by) -> Eigen::VectorXd {
        return (at(member, here + by) - at(member, here - by)) / (2 * by);
      };
      Eigen::VectorXd derivative(2 * n + m);
      derivative << linear.equations_by_start.col(2 * n + j), linear.end_by_start.col(2 * n + j).tail(n);
      detail::require_derivative(places_.names[std::size_t(j)], derivative, difference(width), difference(width / 2),
                                 at(member, here).norm() / width);
    }
  }

  Sys system_;
  std::unique_ptr<Integrator<Sys>> integrator_;
  ParameterPlaces places_;
  ObserveNode<Sys> observe_;
  std::vector<LinearStep> stages_;
  std::size_t used_ = 0;
  double step_size_ = 0;  ///< of the first step
  bool compared_ = false;
};

}  // namespace lagroid
