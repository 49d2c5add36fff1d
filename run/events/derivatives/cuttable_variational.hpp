#pragma once
/// The motion of a system by variational steps that can be made in part (cuttable_motion.hpp), of one arrow or
/// composed: an arrow over the share gamma s of a part of the duration s, which begins at t + c s, solves
///
///     F-(g, lambda; t + c s, gamma s) = mu,    phi(g; t + c s, gamma s) = 0,
///
/// and is linearised by the size and the time, too, as by parameters.
///
///     CuttableVariational<Bob> motion(bob, std::move(integrator), {"stiffness"}, {}, end_state);
///     motion.keep();
///     if (motion.go(0.3 * bob.h).converged()) use(motion.part());
///
/// Parameters that events `set` come behind those that are asked for, unless they are among them.
///
/// Requires an integrator at its start, whose steps can be made in part and solve the equations of the system: reduced
/// ones do, where nothing is changed on the way. Errors: those of LinearisedMotionOf; std::invalid_argument for what is
/// set and is no single number; WithoutDerivative for a parameter, or a force's step size, that the system reads as a
/// plain number, which is found where it first varies, by comparison with differences. A value that the system refuses
/// is std::domain_error, a rest of a step that does not converge its StepReport.

#include <lagroid/run/motion/parameter_values.hpp>
#include <lagroid/solvers/sensitivity/linearised_motion_of.hpp>
#include <lagroid/solvers/sensitivity/times/cuttable_motion.hpp>
#include <lagroid/solvers/sensitivity/times/timed_node.hpp>
#include <lagroid/solvers/sensitivity/times/varying_step.hpp>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

namespace detail {

/// The names of parameters and, behind them, of those that are set and not among them.
template <DiscreteSystem Sys>
std::vector<std::string> with_set_numbers(const Sys& system, std::vector<std::string> parameters,
                                          const std::vector<std::string>& set) {
  parameters = places_of_parameters(system, parameters).names;
  for (const std::string& name : set) {
    if (std::find(parameters.begin(), parameters.end(), name) != parameters.end()) continue;
    if (places_of_parameters(system, {name}).names.front() != name)
      throw std::invalid_argument(name + ", which an event sets, is no single number");
    parameters.push_back(name);
  }
  return parameters;
}

}  // namespace detail

template <DiscreteSystem Sys>
requires StepDependent<Sys> || TimeDependent<Sys>
class CuttableVariational final : public CuttableMotion {
 public:
  static constexpr int n = Sys::dimension;
  static constexpr int m = Sys::constraints;

  CuttableVariational(const Sys& system, std::unique_ptr<Integrator<Sys>> integrator,
                      const std::vector<std::string>& parameters, const std::vector<std::string>& set,
                      ObserveTimedNode<Sys> observe)
      : whole_(system, std::move(integrator), detail::with_set_numbers(system, parameters, set),
               [observe](const ObservedNode<Sys>& node) {
                 return observe({node.system, node.time, node.object, node.momentum, node.configuration});
               }),
        in_part_(system),
        places_(places_of_parameters(in_part_.plain(), whole_.parameter_names())),
        members_(places_.members),
        observe_(std::move(observe)),
        comparisons_(places_.members.size() + 2),
        here_(whole_.point()),
        size_(time_step(in_part_.plain())),
        rest_(size_) {
    members_.push_back(&start_of_part());
    members_.push_back(&in_part_.h);
    const std::size_t asked = places_of_parameters(system, parameters).names.size();
    for (std::size_t j = asked; j < places_.names.size(); ++j) {
      whole_.comparisons().hold(j);
      comparisons_.hold(j);
    }
    comparisons_.hold(places_.names.size());  // the time, which systems read in formulas of it
  }
  CuttableVariational(const CuttableVariational&) = delete;  // derivatives know members by their places
  CuttableVariational& operator=(const CuttableVariational&) = delete;

  int states() const override { return 2 * n; }
  int parameters() const override { return whole_.parameters(); }
  double time() const override { return here_.time; }

  StepReport advance() override {
    const double begun = whole_.time();
    const StepReport report = whole_.advance();
    here_ = whole_.point();
    size_ = rest_ = here_.time - begun;
    return report;
  }
  bool linearise() override { return whole_.linearise(); }
  int stages() const override { return whole_.stages(); }
  const StepDerivative& stage(int k) const override { return whole_.stage(k); }
  NodeValues observe() const override {
    NodeValues out = observe_in_part();
    out.derivatives.conservativeResize(Eigen::NoChange, states() + parameters());
    return out;
  }

  void keep() override {
    if (is_changed_) return;  // which the integrator has kept itself
    whole_.integrator().keep_node();
    rest_ = size_;
  }
  StepReport go(double duration) override {
    gone_ = duration;
    arrows_.clear();
    TrajectoryPoint<Sys> to;
    const auto visit = [&](const Step<Sys>& step, double start, double size) {
      arrows_.push_back({step, start, size});
    };
    const StepReport report = whole_.integrator().cut(share(), to, visit);
    if (!report.converged()) return report;
    if (duration != 0) arrows_.push_back({to.step, to.time - to.step_size, to.step_size});
    here_ = to;
    return report;
  }
  Derivatives part() override {
    const int time_row = states() + parameters();
    Derivatives out;
    // (t, s) become those of the first arrow, then of the next one, and at the end what they were.
    const auto turn = [&](double t_by_size, double size_by_size) {
      Eigen::MatrixXd by = Eigen::MatrixXd::Zero(2, time_row + 2);
      by(0, time_row) = 1;
      by(0, time_row + 1) = t_by_size;
      by(1, time_row + 1) = size_by_size;
      out.push_back(std::make_shared<ReplacedRows>(time_row, std::move(by)));
    };
    const bool is_composed = arrows_.size() > 1;
    for (std::size_t k = 0; k < arrows_.size(); ++k) {
      const Arrow& arrow = arrows_[k];
      if (is_composed && k == 0) turn(0, arrow.size / gone_);
      if (k > 0) turn(1, arrow.size / arrows_[k - 1].size);
      const auto linear = std::make_shared<LinearStep>(n + m, 2 * n, int(members_.size()));
      set_time_step(in_part_.plain(), arrow.size);
      set_time(in_part_.plain(), arrow.start);
      linearise_step(in_part_, Step<Varying>{arrow.step.arrow, arrow.step.multipliers}, members_, *linear);
      compare(arrow.step, *linear);
      if (!linear->factor()) return {};
      out.push_back(linear);
    }
    if (is_composed)
      turn((arrows_.front().start - arrows_.back().start) / arrows_.back().size, gone_ / arrows_.back().size);
    return out;
  }
  void end_step() override {
    here_ = whole_.point();
    is_changed_ = false;
  }
  void leave_step() override { here_ = whole_.point(); }

  Eigen::VectorXd seen() const override {
    const int none = states() + parameters() + 1;  // of the directions
    const VariedVector here =
        detail::varied_at(in_part_.plain(), places_, here_, none,
                          [&](const auto& object, const auto& momentum, const auto& configuration) {
                            return observe_({in_part_.plain(), here_.time, object, momentum, configuration});
                          });
    Eigen::VectorXd out(here.size());
    for (Eigen::Index i = 0; i < here.size(); ++i) out(i) = here(i).value;
    return out;
  }
  NodeValues observe_in_part() const override {
    const int time_row = states() + parameters();
    return detail::values_at(in_part_.plain(), places_, here_, 1,
                             [&](int first, const auto& object, const auto& momentum, const auto& configuration) {
                               const auto time = detail::varied_along(Vector<double, 1>(here_.time), time_row - first);
                               return observe_({in_part_.plain(), time(0), object, momentum, configuration});
                             });
  }

  void kick(const Eigen::VectorXd& by) override {
    const AlgebroidVector<typename Sys::GroupoidType> kick = by;
    go_on_after(whole_.integrator().kick(share(), kick));
    here_.state.momentum += kick;
  }
  int place_of(const std::string& number) const override {
    const auto found = std::find(places_.names.begin(), places_.names.end(), number);
    if (found == places_.names.end()) return CuttableMotion::place_of(number);
    return int(found - places_.names.begin());
  }
  void set(const std::vector<SetNumber>& numbers) override {
    std::vector<ParameterValue> to;
    for (const SetNumber& each : numbers) to.push_back({each.name, each.value});
    if (const std::string why = give(to); !why.empty()) throw std::domain_error(why);
    go_on_after(whole_.integrator().change(share(), [&to](Sys& system) { set_parameters(system, to); }));
    for (const SetNumber& each : numbers) {
      if (!each.varies) continue;
      whole_.comparisons().vary(std::size_t(place_of(each.name)));
      comparisons_.vary(std::size_t(place_of(each.name)));
    }
  }

  void serialize(NumberArchive& archive) override {
    restore_numbers(archive);
    whole_.serialize(archive);
    here_.serialize(in_part_.groupoid, archive);
    is_changed_ = false;
  }

 private:
  using Varying = VaryingStep<Sys>;
  /// One that a part is composed of.
  struct Arrow {
    Step<Sys> step;
    double start;
    double size;
  };

  /// Of the step, or of its rest after a change, that has been gone.
  double share() const { return gone_ == 0 ? 0 : gone_ / rest_; }
  void go_on_after(const StepReport& report) {
    if (!report.converged()) throw report;
    rest_ -= gone_;
    gone_ = 0;
    is_changed_ = true;
  }
  /// What systems that do not depend on it do not have.
  double& start_of_part() {
    if constexpr (TimeDependent<Sys>) {
      return in_part_.time;
    } else {
      return unread_;
    }
  }
  /// The size of the step is one of them, which a force may read as a plain number.
  void compare(const Step<Sys>& step, const LinearStep& linear) {
    comparisons_.take([&](std::size_t j) {
      detail::compare_with_differences(in_part_.plain(), const_cast<double&>(*members_[j]),  // of the system
                                       j < places_.names.size() ? places_.names[j] : "h", step, linear,
                                       2 * n + Eigen::Index(j));
    });
  }
  /// To the systems of parts and of whole steps; why it is refused, if it is.
  std::string give(const std::vector<ParameterValue>& to) {
    set_parameters(whole_.system(), to);
    return set_parameters(in_part_.plain(), to);
  }
  /// What has been set is what it was where the archive was written.
  void restore_numbers(NumberArchive& archive) {
    std::vector<ParameterValue> to;
    for (std::size_t j = 0; j < places_.names.size(); ++j) {
      double value = *places_.members[j];
      archive(value);
      if (value != *places_.members[j]) to.push_back({places_.names[j], value});
    }
    if (to.empty()) return;
    give(to);
    whole_.integrator().change_here([&to](Sys& system) { set_parameters(system, to); });
  }

  LinearisedMotionOf<Sys> whole_;
  Varying in_part_;
  double unread_ = 0;
  ParameterPlaces places_;
  std::vector<const double*> members_;  ///< and when an arrow begins, and its size
  ObserveTimedNode<Sys> observe_;
  Comparisons comparisons_;    ///< of these
  TrajectoryPoint<Sys> here_;  ///< in a step, or at a node
  double size_;                ///< of the last step
  double rest_;                ///< of it, from where parts begin
  double gone_ = 0;            ///< of it, by the last part
  std::vector<Arrow> arrows_;  ///< of that part
  bool is_changed_ = false;    ///< where parts begin
};

}  // namespace lagroid
