#include <lagroid/run/motion/integrate_nodes.hpp>

#include <cmath>

namespace lagroid {

bool WatchedMotion::observe() {
  if (!std::isfinite(motion_.time())) return false;
  const bool is_recorded = motion_.index() == next_;
  if (is_recorded) next_ += every_;
  return !(is_recorded || is_judged_at_every_node_) || see(is_recorded);
}

bool WatchedMotion::observe_last() {
  const bool was_recorded = motion_.index() == next_ - every_;
  return was_recorded || !std::isfinite(motion_.time()) || see(true);
}

bool WatchedMotion::see(bool is_recorded) {
  const Observables& node = motion_.look();
  if (judge_ != nullptr && judged_ < node.index()) judge_->observe(node);
  judged_ = node.index();
  if (recorder_ != nullptr && is_recorded) recorder_->record(node, judge_);
  return node.finite();
}

IntegrationEnd integrate_nodes(WatchedMotion& watched, long count,
                               const std::function<bool(const StepReport&)>& goes_on) {
  for (long k = 0; k < count; ++k) {
    const StepReport report = watched.motion().advance();
    if (!report.converged()) return {IntegrationEnd::Why::failed, report};
    if (!watched.observe()) return {IntegrationEnd::Why::not_finite, report};
    if (!goes_on(report)) return {IntegrationEnd::Why::stopped, report};
  }
  return {};
}

}  // namespace lagroid
