#include <lagroid/solvers/control/ipopt/ipopt_control.hpp>
#include <lagroid/solvers/control/ipopt/ipopt_program.hpp>
#include <lagroid/solvers/control/stage_kkt.hpp>

#include <fmt/format.h>
#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lagroid {

namespace {

ControlStatus status_of(Ipopt::ApplicationReturnStatus ended) {
  switch (ended) {
    case Ipopt::Solve_Succeeded:
      return ControlStatus::converged;
    case Ipopt::Infeasible_Problem_Detected:
      return ControlStatus::infeasible;
    case Ipopt::Solved_To_Acceptable_Level:
    case Ipopt::Search_Direction_Becomes_Too_Small:
    case Ipopt::Restoration_Failed:
      return ControlStatus::stagnated;
    case Ipopt::Error_In_Step_Computation:
    case Ipopt::Not_Enough_Degrees_Of_Freedom:
      return ControlStatus::singular;
    case Ipopt::Invalid_Number_Detected:
      return ControlStatus::not_finite;
    default:
      return ControlStatus::not_converged;
  }
}

std::string message_of(ControlStatus status, Ipopt::ApplicationReturnStatus ended) {
  switch (status) {
    case ControlStatus::converged:
      return "";
    case ControlStatus::infeasible:
      return "IPOPT: the violation of the constraints has a local minimum here; start from another trajectory, or "
             "relax "
             "the constraints that are listed";
    case ControlStatus::stagnated:
      return "IPOPT: no step is better, though the tolerance is not reached: scale the cost, give a tolerance that "
             "rounding allows, or start elsewhere";
    case ControlStatus::singular:
      return "IPOPT: no shift makes the KKT matrix that of a minimum: are constraints given twice?";
    case ControlStatus::not_finite:
      return "IPOPT: a cost or constraint is not finite; start from another trajectory";
    case ControlStatus::not_converged:
      break;
  }
  return fmt::format(
      "IPOPT: not converged (its return code is {}); start from another trajectory, or allow more iterations",
      int(ended));
}

/// The largest five of what is violated.
std::vector<ConstraintViolation> worst_of(const TranscriptionSizes& sizes, const StageValues& values,
                                          double tolerance) {
  std::vector<ConstraintViolation> all;
  const auto take = [&](const ConstraintViolation& each) {
    if (each.amount > tolerance) all.push_back(each);
  };
  for (long k = 0; k < sizes.stages; ++k) {
    for (int i = 0; i < sizes.equalities_of(k); ++i) take({k, i, true, std::abs(values.equality[k][i])});
    for (int i = 0; i < sizes.inequality; ++i) take({k, i, false, values.inequality[k][i]});
  }
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.amount > b.amount; });
  all.resize(std::min<std::size_t>(5, all.size()));
  return all;
}

/// Whether the KKT matrix has the inertia of a strict minimum, z_i / -gamma_i taken as it stands.
bool is_strict_minimum(const Transcription& transcription, const StageValues& values,
                       const StageDerivatives& derivatives, const StageRows& multipliers) {
  const TranscriptionSizes& sizes = transcription.sizes();
  constexpr double least_slack = 1e-14;
  StageRows sigma = multipliers;
  for (std::size_t i = 0; i < sigma.numbers().size(); ++i)
    sigma.numbers()[i] /= std::max(-values.inequality.numbers()[i], least_slack);
  StageKkt kkt(transcription);
  kkt.assemble(derivatives, sigma);
  return kkt.factor(0, StageRows(sizes.stages, sizes.equality)).negative == kkt.equalities();
}

}  // namespace

bool has_ipopt() { return true; }

IpoptSolution solve_by_ipopt(TrajectoryChart& chart, const ControlOptions& options) {
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> application =
      new Ipopt::IpoptApplication(/*create_console_out=*/false);
  const Ipopt::SmartPtr<Ipopt::OptionsList> set = application->Options();
  set->SetIntegerValue("print_level", 0);
  set->SetStringValue("sb", "yes");
  set->SetStringValue("linear_solver", "mumps");
  set->SetIntegerValue("max_iter", options.max_iterations);
  set->SetIntegerValue("acceptable_iter", 0);
  set->SetNumericValue("bound_relax_factor", 0);
  for (const char* tolerance : {"tol", "constr_viol_tol", "compl_inf_tol"})
    set->SetNumericValue(tolerance, options.tolerance);
  if (application->Initialize() != Ipopt::Solve_Succeeded) throw std::runtime_error("IPOPT cannot be initialised");

  Ipopt::SmartPtr<ControlProgram> program = new ControlProgram(chart, ControlProgram::Blocks::sparse);
  Ipopt::ApplicationReturnStatus ended = application->OptimizeTNLP(program);
  if (program->missed_an_entry()) {
    program = new ControlProgram(chart, ControlProgram::Blocks::whole);
    ended = application->OptimizeTNLP(program);
  }

  const Transcription& transcription = chart.transcription();
  const TranscriptionSizes& sizes = transcription.sizes();
  IpoptSolution out{{}, program->costates(), program->inequality_multipliers()};
  StageValues values(sizes);
  StageDerivatives derivatives(sizes);
  TrajectoryDisplacement gradient(sizes);
  transcription.values(values);
  transcription.derivatives(out.costates, out.inequality_multipliers, derivatives);
  const KktResidual left =
      kkt_residual(transcription, values, derivatives, out.costates, out.inequality_multipliers, gradient);
  ControlReport& report = out.report;
  report.status = status_of(ended);
  if (Ipopt::IsValid(application->Statistics())) report.iterations = int(application->Statistics()->IterationCount());
  for (const double each : values.cost.numbers()) report.cost += each;
  report.stationarity = left.stationarity;
  report.violation = left.violation;
  report.complementarity = left.complementarity;
  report.is_strict_minimum =
      report.converged() && is_strict_minimum(transcription, values, derivatives, out.inequality_multipliers);
  report.message = message_of(report.status, ended);
  if (!report.converged()) report.worst = worst_of(sizes, values, options.tolerance);
  return out;
}

}  // namespace lagroid
