#pragma once
/// A system's march, driven, recorded and judged.

#include <lagroid/core/discrete_energy.hpp>
#include <lagroid/run/recorder.hpp>
#include <lagroid/run/stepped_run.hpp>
#include <lagroid/solvers/constrained_momentum.hpp>
#include <lagroid/solvers/march.hpp>
#include <lagroid/solvers/method.hpp>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

/// What to say of a step that failed.
std::string step_failure(const StepReport& report, long step, double time, TimeMode mode);
/// What to say of steps whose size was not what the mode asks for.
std::string without_root_note(long count, long steps, WithoutRoot instead);
/// In words, what a method declares of itself.
std::string description(const MethodTraits& method);

/// The point with its momentum made tangent to the object constraints, as it is reported.
template <DiscreteSystem Sys> TrajectoryPoint<Sys> reported(const Sys& system, TrajectoryPoint<Sys> point) {
  point.state.momentum = tangent_momentum(system, point.state);
  return point;
}

/// What the ledger watches: `quantities_of` the system, and E_d where the steps keep it or vary.
template <DiscreteSystem Sys> std::vector<Quantity<Sys>> watched(const Sys& system, const MarchOptions& options) {
  auto all = quantities_of(system);
  if constexpr (Timed<Sys>) {
    if (options.mode == TimeMode::adaptive && !TimeDependent<Sys>) {
      const bool kept = options.without_root == WithoutRoot::stop;
      all.push_back(discrete_energy_quantity(system, kept ? Promise::conserved : Promise::bounded));
    }
  }
  return all;
}

/// The presentation with the step sizes, where they vary: a series and a panel.
template <DiscreteSystem Sys> Presentation<Sys> with_step_sizes(Presentation<Sys> p, const MarchOptions& options) {
  if (options.mode == TimeMode::fixed) return p;
  p.extras.push_back({{"step_size", {"h"}, "s", "step size of the arrow", true, {}},
                      [](const TrajectoryPoint<Sys>& point, double* out) { *out = point.step_size; }});
  p.panels.push_back({"step size", "t", "h", "t", {"h"}});
  if (options.mode == TimeMode::adaptive && !TimeDependent<Sys>)
    p.panels.push_back({"discrete energy error", "t", "|E_d - first|", "t", {"drift discrete energy E_d"}});
  return p;
}

/// A system's march with all that is told of it.
template <DiscreteSystem Sys> class SystemRun final : public SteppedRun {
 public:
  using G = typename Sys::GroupoidType;

  /// `options` are those that the march was made with; the presentation must outlive this.
  SystemRun(const Sys& system, const Presentation<Sys>& presentation, std::vector<Quantity<Sys>> quantities,
            std::unique_ptr<March<Sys>> march, const MarchOptions& options, long every,
            const Observer<Sys>& observer = nullptr)
      : system_(system),
        mode_(options.mode),
        without_root_(options.without_root),
        march_(std::move(march)),
        recorder_(system, presentation, std::move(quantities), every, observer) {}

  /// Runs it (`drive`) and puts all that was seen into the result.
  void go(const Pace& pace, const RunContext& context, RunResult& result) {
    result.method = description(march_->traits());
    drive(*this, pace, context, result);
    recorder_.finish(result);
    if (const long count = march_->without_root(); count > 0) {
      result.notes.push_back(without_root_note(count, result.steps, without_root_));
      result.ledger.entries.push_back(counted_entry("steps off the energy", count, result.steps));
    }
  }

  StepReport advance() override { return march_->advance(); }
  std::string failure(const StepReport& report, long step) const override {
    return step_failure(report, step, march_->point().time, mode_);
  }
  bool observe(long step) override {
    if (!std::isfinite(march_->point().time)) return false;
    if (step > 0)
      march_->for_each_inner_stage(
          [&](const Step<Sys>& inner, double from, double size) { recorder_.watch_constraint(inner, from, size); });
    recorder_.observe(reported(system_, march_->point()));
    return true;
  }
  Trajectory& trajectory() override { return recorder_.trajectory(); }
  void persist(Archive& archive) override {
    archive.tape("march", [&](Tape& tape) { march_->persist(tape); });
    archive("recorder", recorder_);
  }

 private:
  Sys system_;
  TimeMode mode_;
  WithoutRoot without_root_;
  std::unique_ptr<March<Sys>> march_;
  Recorder<Sys> recorder_;
};

}  // namespace lagroid
