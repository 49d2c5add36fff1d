// How an iteration ended, in numbers and in words.
#include <lagroid/solvers/control/interior_point/failure.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lagroid {

void InteriorPoint::describe() {
  const KktResidual at = kkt_residual(transcription_, values_, derivatives_, costates_, multipliers_, gradient_);
  report_.stationarity = at.stationarity;
  report_.violation = at.violation;
  report_.complementarity = at.complementarity;
  report_.cost = 0;
  for (long k = 0; k < sizes_.stages; ++k) report_.cost += values_.cost[k][0];
}

void InteriorPoint::judge() {
  report_.curvature =
      report_.converged() ? curvature_of(kkt_, derivatives_, multipliers_, slacks_, sigma_, dual_) : Curvature::open;
  describe();
  explain();
}

void InteriorPoint::explain() { explain_end(transcription_, values_, derivatives_, options_, report_); }

void explain_end(const Transcription& transcription, const StageValues& values, const StageDerivatives& derivatives,
                 const ControlOptions& options, ControlReport& report) {
  // Rows that repeat each other leave the matrix without the inertia of a strict minimum: else nobody need ask.
  if (report.curvature == Curvature::open && report.status != ControlStatus::not_finite &&
      report.status != ControlStatus::interrupted)
    report.repeated = repeated_constraints(transcription, values, derivatives, options.tolerance);
  if (report.converged()) return;
  if (!report.repeated.empty()) report.status = ControlStatus::redundant;
  report.message = advice_of(report.status, options.max_iterations);
  report.worst = worst_violations(transcription.sizes(), values, options.tolerance);
}

std::string advice_of(ControlStatus status, int max_iterations) {
  switch (status) {
    case ControlStatus::converged:
      break;
    case ControlStatus::infeasible:
      return "the violation of the constraints has a local minimum here; start from another trajectory, or relax the "
             "constraints that are listed";
    case ControlStatus::stagnated:
      return "no step is better, though the KKT residual is above the tolerance: scale the cost, give a tolerance that "
             "rounding allows, or start elsewhere";
    case ControlStatus::not_converged:
      return fmt::format("not converged in {} iterations; start from another trajectory, or allow more",
                         max_iterations);
    case ControlStatus::singular:
      return "no shift makes the KKT matrix that of a minimum: are constraints given twice?";
    case ControlStatus::redundant:
      return "constraints repeat each other at this trajectory, which leaves their multipliers open: leave out what "
             "says the "
             "same; of curves that only touch, ask for the point where they do";
    case ControlStatus::interrupted:
      return "interrupted; the trajectory is the last iterate";
    case ControlStatus::not_finite:
      return "a cost or constraint of the trajectory to start from is not finite; give another";
  }
  return "";
}

std::vector<ConstraintViolation> worst_violations(const TranscriptionSizes& sizes, const StageValues& values,
                                                  double tolerance) {
  std::vector<ConstraintViolation> out;
  const auto take = [&](const ConstraintViolation& each) {
    if (each.amount > tolerance) out.push_back(each);
  };
  for (long k = 0; k < sizes.stages; ++k) {
    for (int i = 0; i < sizes.equalities_of(k); ++i) take({k, i, true, std::abs(values.equality[k][i])});
    for (int i = 0; i < sizes.inequality; ++i) take({k, i, false, values.inequality[k][i]});
  }
  const auto most = std::min<std::size_t>(5, out.size());
  std::partial_sort(out.begin(), out.begin() + long(most), out.end(),
                    [](const auto& a, const auto& b) { return a.amount > b.amount; });
  out.resize(most);
  return out;
}

}  // namespace lagroid
