#include "live_study.hpp"

#include <reading/scene_reader.hpp>
#include <study/scene_experiment.hpp>

#include <algorithm>
#include <chrono>
#include <limits>

namespace lagroid::web {

namespace {

constexpr double longest = 0.2;     // s, of a run
constexpr double first_step = 8;    // of the scene's own
constexpr int most_in_vain = 4;     // runs that fail or are no better
constexpr double as_the_truth = 3;  // times what the reference is known by

/// So many as a picture can show: of each order that with the fewest stages.
std::vector<Method> one_of_each_kind(const std::vector<Method>& all) {
  std::vector<Method> out;
  for (const Method& method : all) {
    const auto same = std::find_if(out.begin(), out.end(), [&](const Method& m) {
      return m.order == method.order && m.equal_steps == method.equal_steps && m.to_compare == method.to_compare;
    });
    if (same == out.end())
      out.push_back(method);
    else if (method.stages < same->stages)
      *same = method;
  }
  return out;
}

/// Seconds by the clock on the wall, for a browser tells no time of the processor; short runs are repeated until the
/// clock can tell. Negative where a run fails.
double time_of(const Experiment& experiment, const Method& method, double step) {
  constexpr double long_enough = 5e-3;
  constexpr int most_runs = 100;
  double total = 0;
  int runs = 0;
  while (total < long_enough && runs < most_runs) {
    const auto motion = experiment.begin(method, step);
    IntegrationCost work;
    const auto begun = std::chrono::steady_clock::now();
    if (!integrate_to(*motion, motion->time() + experiment.end, work).converged()) return -1;
    total += std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    ++runs;
  }
  return total / runs;
}

}  // namespace

LiveStudy::LiveStudy(const std::string& text, const std::vector<std::string>& overrides)
    : experiment_(app::read_experiment(app::parse_scene(text, "scene", overrides, ""))),
      methods_(one_of_each_kind(experiment_.methods)) {
  for (const Method& method : methods_)
    descents_.push_back({first_step * experiment_.step * method.stages, std::numeric_limits<double>::infinity()});
}

double LiveStudy::look_for_reference(double seconds) {
  reference_ = extrapolated_reference(experiment_, seconds);
  return reference_->uncertainty;
}

Measurement LiveStudy::measure(std::size_t which) {
  const Method& method = methods_[which];
  Descent& descent = descents_[which];
  Measurement run = measure_once(experiment_, method, descent.step, reference_.get(), longest);
  descent.step /= 2;
  const bool better = run.converged() && run.trajectory < 0.7 * descent.least;
  descent.in_vain = better ? 0 : descent.in_vain + 1;
  if (better) descent.least = run.trajectory;
  if (run.converged()) {
    const double alone = time_of(experiment_, method, run.step);
    if (alone >= 0) run.seconds = {alone};
  }
  descent.done =
      descent.in_vain >= most_in_vain || run.status == "too slow" ||
      (run.converged() && (run.median() > longest / 4 || run.trajectory < as_the_truth * reference_->uncertainty));
  return run;
}

std::optional<Measurement> LiveStudy::next() {
  for (std::size_t tried = 0; tried < descents_.size(); ++tried) {
    const std::size_t which = turn_++ % descents_.size();
    if (!descents_[which].done) return measure(which);
  }
  return std::nullopt;
}

}  // namespace lagroid::web
