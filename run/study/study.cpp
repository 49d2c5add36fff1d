#include <lagroid/run/interrupt.hpp>
#include <lagroid/run/machine.hpp>
#include <lagroid/run/reports/progress.hpp>
#include <lagroid/run/study/study.hpp>

#include <algorithm>
#include <utility>

namespace lagroid {

Findings study(const Experiment& experiment, const StudyRequest& request,
               const std::function<bool(double spent)>& goes_on) {
  const Budget budget(request.budget);
  const Experiment bounded = within(experiment, budget);
  const auto reference =
      request.reference ? request.reference(bounded) : extrapolated_reference(bounded, request.reference_seconds);
  Findings findings;
  findings.name = experiment.name;
  findings.machine = machine();
  findings.end = experiment.end;
  findings.target = request.target;
  findings.methods = request.methods.empty() ? experiment.methods : request.methods;
  findings.reference = reference->description;
  findings.uncertainty = reference->uncertainty;
  findings.reference_state = reference->at(experiment.end);
  findings.budget = request.budget;
  findings.repetitions = request.repetitions;
  Survey found = survey(bounded, findings.methods, request.steps, *reference, request.repetitions, budget,
                        [&](double spent) { return !goes_on || goes_on(spent); });
  findings.runs = std::move(found.runs);
  findings.left_out = std::move(found.left_out);
  findings.interrupted = experiment.stopped();
  return findings;
}

Findings study_until_interrupted(Experiment experiment, const StudyRequest& request, bool progress) {
  constexpr long whole = 1000;
  Progress bar("study", whole, progress);
  const InterruptGuard guard;
  experiment.interrupted = InterruptGuard::interrupted;
  return study(experiment, request, [&](double spent) {
    bar.update(long(double(whole) * std::min(spent, 1.0)));
    return !InterruptGuard::interrupted();
  });
}

}  // namespace lagroid
