#include <lagroid/run/followed_run.hpp>
#include <lagroid/solvers/step/step_messages.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace lagroid {

using Why = IntegrationEnd::Why;

FollowedRun::FollowedRun(Motion& motion, const RunExtent& extent, bool record, RunResult& result)
    : motion_(motion),
      result_(result),
      steps_(extent.steps),
      record_(record),
      first_(motion.look()),
      judge_(first_),
      recorder_(first_),
      watched_(motion, &judge_, record ? &recorder_ : nullptr, extent.every) {
  if (!extent.events.empty()) events_.emplace(extent.events, motion);
  result.system = motion.name();
  result.method = description(motion.traits());
  result.steps_asked = extent.steps;
  result.initial = first_.endpoint();
}

void FollowedRun::count(const StepReport& report) {
  result_.iterations += report.iterations;
  result_.ledger.most_iterations = std::max(result_.ledger.most_iterations, report.iterations);
}

void FollowedRun::advance(long steps, const std::function<bool(const StepReport&)>& goes_on) {
  steps = std::min(steps, steps_ - result_.steps);
  const auto made = [&](const StepReport& report) {
    count(report);
    ++result_.steps;
    return !goes_on || goes_on(report);
  };
  end_ = events_ ? integrate_nodes(watched_, *events_, steps, made) : integrate_nodes(watched_, steps, made);
}

bool FollowedRun::goes_on() const {
  return (end_.why == Why::whole || end_.why == Why::stopped) && result_.steps < steps_;
}

Ledger FollowedRun::ledger() const {
  Ledger ledger = result_.ledger;
  judge_.report(ledger);
  ledger.mean_iterations = result_.steps > 0 ? double(result_.iterations) / double(result_.steps) : 0;
  return ledger;
}

void FollowedRun::tell_end() {
  if (end_.why == Why::failed) {
    count(end_.report);
    result_.status = std::string(to_string(end_.report.status));
    result_.residual = end_.report.residual;
    result_.message = motion_.failure(end_.report, result_.steps + 1);
  } else if (end_.why == Why::event) {
    if (end_.report.converged()) count(end_.report);
    ++result_.steps;
    if (end_.report.converged()) {
      result_.notes.push_back(events_->reason());
    } else {
      result_.status = std::string(to_string(end_.report.status));
      result_.message = events_->reason();
    }
  } else if (end_.why == Why::not_finite) {
    count(end_.report);
    ++result_.steps;
    result_.status = std::string(to_string(SolveStatus::not_finite));
    result_.message = fmt::format(
        "step {}: time, energy or constraints are no finite numbers any more; use a smaller step", result_.steps);
  }
}

void FollowedRun::finish() {
  if (!watched_.observe_last() && result_.converged()) {
    result_.status = std::string(to_string(SolveStatus::not_finite));
    result_.message = "energy or constraints are no finite numbers at the end; use a smaller or a larger step";
  }
  result_.ledger = ledger();
  if (record_) result_.trajectory = std::move(recorder_.trajectory());
  result_.final =
      end_.why == Why::event && end_.report.converged() ? events_->end().endpoint() : motion_.look().endpoint();
  motion_.describe(result_);
  if (events_) events_->report(result_);
}

}  // namespace lagroid
