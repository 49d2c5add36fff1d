#pragma once
/// Runs of systems of a test's own on R^n, as what `lagroid gradient` and `lagroid fit` differentiate.

#include <gradient/gradient_subject.hpp>

#include <lagroid/solvers/sensitivity/sensitivities.hpp>
#include <lagroid/systems/mechanical.hpp>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::app {

/// By equal steps, observed by place and momentum, which these are the names of.
template <int N, class Sys>
GradientSubject subject_of_run(std::string name, const Sys& system, const State<Pair<N>>& start, long steps,
                               std::vector<GradientName> names) {
  GradientSubject out;
  out.system = std::move(name);
  out.steps = steps;
  out.observed = out.start = std::move(names);
  out.sizes = {start.object.begin(), start.object.end()};
  out.sizes.insert(out.sizes.end(), start.momentum.begin(), start.momentum.end());
  name_parameters(system, out);
  out.begin = [system, start](const std::vector<std::string>& parameters, const std::vector<Nudge>& nudges) {
    Sys other = system;
    State<Pair<N>> from = start;
    nudge_parameters(other, nudges);
    for (const Nudge& nudge : nudges)
      if (nudge.parameter.empty())
        (nudge.index < N ? from.object(nudge.index) : from.momentum(nudge.index - N)) += nudge.by;
    return std::make_unique<LinearisedMotionOf<Sys>>(other, detail::newton_integrator<Sys>(other, from, {}), parameters,
                                                     [](const ObservedNode<Sys>& node) {
                                                       VariedVector both(2 * N);
                                                       both << node.object, node.momentum;
                                                       return both;
                                                     });
  };
  return out;
}

}  // namespace lagroid::app
