#include <lagroid/run/motion/integrate_nodes.hpp>

#include <cmath>

namespace lagroid {

bool WatchedMotion::observe() {
  if (!std::isfinite(motion_.time())) return false;
  const bool is_recorded = takes_row();
  return !(is_recorded || is_judged_at_every_node_) || see(motion_.look(), is_recorded);
}

bool WatchedMotion::observe(const Observables& node) {
  const bool is_recorded = takes_row();
  return !(is_recorded || is_judged_at_every_node_) || see(node, is_recorded);
}

bool WatchedMotion::observe_last() {
  const bool was_recorded = motion_.index() == next_ - every_;
  return is_ended_ || was_recorded || !std::isfinite(motion_.time()) || see(motion_.look(), true);
}

void WatchedMotion::end_at(const Observables& inside) {
  is_ended_ = true;
  if (judge_ != nullptr) judge_->observe(inside);
  if (recorder_ != nullptr) recorder_->record(inside, judge_);
}

bool WatchedMotion::takes_row() {
  if (motion_.index() != next_) return false;
  next_ += every_;
  return true;
}

bool WatchedMotion::see(const Observables& node, bool is_recorded) {
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
