#pragma once
/// The motion of a system by explicit steps that can be made in part (cuttable_motion.hpp): a part of the duration s is
/// the same closed form with s in place of h, and so it is over numbers with derivatives, by s too.
///
/// Of the duration a step knows by how fast time passes: `System` is the system with a `rate`, r = 1, at which its
/// flows or rates go, so that a step of the size s is one of r s, and its derivative by r is s times that by s. With
/// that system, and Steps as of LinearisedExplicit that have `begin_cut` and `go_on_from`, LinearisedSplitting and
/// LinearisedRungeKutta are such motions.
///
///     LinearisedSplitting<Kepler> motion(kepler, start, unit, splittings::srkn6, {"strength"}, end_state);
///     motion.keep();
///     if (motion.go(0.3 * kepler.h).converged())  // three tenths of a step
///       for (const auto& each : motion.part()) derivatives.push_back(each);
///
/// Requires steps that do not depend on the time. Errors: those of LinearisedExplicit; WithoutDerivative for a part of
/// a step whose system takes times as plain numbers alone (`has_rate`).

#include <lagroid/solvers/sensitivity/explicit/linearised_explicit.hpp>
#include <lagroid/solvers/sensitivity/times/cuttable_motion.hpp>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

/// Sys: the system; System: the same with a rate; Steps: of that.
template <DiscreteSystem Sys, class System, class Steps>
class CuttableExplicit : public LinearisedExplicit<System, Steps, CuttableMotion> {
 public:
  using Whole = LinearisedExplicit<System, Steps, CuttableMotion>;

  CuttableExplicit(const System& system, Steps steps, const std::vector<std::string>& parameters,
                   ObserveNode<Sys> observe)
      : Whole(system, std::move(steps), parameters,
              [observe = std::move(observe)](const ObservedNode<System>& node) {
                return observe({node.system, node.time, node.object, node.momentum, node.configuration});
              }),
        here_(this->steps().point()) {}

  int momenta() const override { return Sys::dimension; }
  double time() const override { return here_.time; }
  StepReport advance() override {
    const StepReport report = Whole::advance();
    here_ = this->steps().point();
    return report;
  }
  NodeValues observe() const override { return this->observe_at(here_); }

  void keep() override { kept_ = here_; }
  StepReport go(double duration) override {
    StepReport report;
    report.status = SolveStatus::converged;
    here_ = kept_;
    duration_ = duration;
    if (duration == 0) return report;
    Steps part = this->steps();
    part.begin_cut(kept_, duration / this->system().h);
    report = part.advance();
    if (!report.converged()) return report;
    here_ = part.point();
    here_.time = kept_.time + duration;
    return report;
  }
  Derivatives part() override {
    if (!System::has_rate)
      throw WithoutDerivative("parts of these steps have no derivative: flows of the system take a time as a number");
    const Eigen::Index own = this->states() + this->parameters();
    auto members = this->members();
    members.push_back(&this->system().rate);
    const double size = std::exchange(this->system().h, duration_);
    Eigen::MatrixXd by;
    this->differentiate(kept_, here_, members, by);
    this->system().h = size;
    if (!by.allFinite()) return {};
    // Nothing depends on the time at which it begins.
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(by.rows(), own + 2);
    all.leftCols(own) = by.leftCols(own);
    all.col(own + 1) = by.col(own) / duration_;
    return {std::make_shared<ReplacedRows>(0, std::move(all))};
  }
  void end_step() override {
    here_.index = this->steps().point().index;
    here_.time = this->steps().point().time;
    this->steps().go_on_from(here_);
  }
  void leave_step() override { here_ = this->steps().point(); }

  Eigen::VectorXd seen() const override { return this->values_at(here_); }
  NodeValues observe_in_part() const override {
    NodeValues out = this->observe_at(here_);
    out.derivatives.conservativeResize(Eigen::NoChange, out.derivatives.cols() + 1);
    out.derivatives.rightCols(1).setZero();
    return out;
  }
  void kick(const Eigen::VectorXd& by) override { here_.state.momentum += by; }

  void serialize(NumberArchive& archive) override {
    Whole::serialize(archive);
    here_.serialize(this->system().groupoid, archive);
  }

 private:
  TrajectoryPoint<System> here_;  ///< in a step, or at a node
  TrajectoryPoint<System> kept_;  ///< where parts begin
  double duration_ = 0;           ///< of the last part
};

}  // namespace lagroid
