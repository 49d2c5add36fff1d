#include <lagroid/run/study/study_integrator.hpp>

namespace lagroid {

StepReport advance(Motion& motion, IntegrationCost& work) {
  const StepReport report = motion.advance();
  if (report.converged()) {
    ++work.steps;
    work.evaluations += motion.evaluations(report);
  }
  return report;
}

StepReport integrate_to(Motion& motion, double end, IntegrationCost& work) {
  StepReport report;
  report.status = SolveStatus::converged;
  while (report.converged() && end - motion.time() > 0.5 * motion.step_size()) report = advance(motion, work);
  return report;
}

NodeObservation observation_of(Motion& motion) {
  const Observables& node = motion.look();
  NodeObservation sight{{}, motion.defect()};
  for (std::size_t i = 0; i < node.quantities().size(); ++i) {
    const Watched& quantity = node.quantities()[i];
    if (quantity.on_arrows && node.index() == 0) continue;
    NamedVector seen{quantity.name, std::vector<double>(quantity.components.size())};
    seen.size = node.measure(i, seen.values.data());
    sight.invariants.push_back(std::move(seen));
  }
  return sight;
}

}  // namespace lagroid
