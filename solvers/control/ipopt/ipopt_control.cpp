#include <lagroid/solvers/control/interior_point/failure.hpp>
#include <lagroid/solvers/control/ipopt/ipopt_control.hpp>
#include <lagroid/solvers/control/ipopt/ipopt_program.hpp>

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
    case Ipopt::User_Requested_Stop:
      return ControlStatus::interrupted;
    default:
      return ControlStatus::not_converged;
  }
}

/// IPOPT stops before the last iteration for reasons of its own, too: then its return code says which.
std::string message_of(const ControlReport& report, Ipopt::ApplicationReturnStatus ended) {
  if (report.converged()) return "";
  if (report.status == ControlStatus::not_converged && ended != Ipopt::Maximum_Iterations_Exceeded)
    return fmt::format("IPOPT: ended with return code {}; start from another trajectory", int(ended));
  return "IPOPT: " + report.message;
}

/// Of slacks as they stand, those of an interior point or smaller.
Curvature curvature_of(const Transcription& transcription, const StageValues& values,
                       const StageDerivatives& derivatives, const StageRows& multipliers) {
  const TranscriptionSizes& sizes = transcription.sizes();
  constexpr double least_slack = 1e-14;
  StageRows slacks = values.inequality;
  for (double& s : slacks.numbers()) s = std::max(-s, least_slack);
  StageKkt kkt(transcription);
  StageRows sigma(sizes.stages, sizes.inequality);
  StageRows dual(sizes.stages, sizes.equality);
  return lagroid::curvature_of(kkt, derivatives, multipliers, slacks, sigma, dual);
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

  Ipopt::SmartPtr<ControlProgram> program =
      new ControlProgram(chart, ControlProgram::Blocks::sparse, options.keep_going);
  Ipopt::ApplicationReturnStatus ended = application->OptimizeTNLP(program);
  if (program->missed_an_entry()) {
    program = new ControlProgram(chart, ControlProgram::Blocks::whole, options.keep_going);
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
  if (report.converged())
    report.curvature = curvature_of(transcription, values, derivatives, out.inequality_multipliers);
  explain_end(transcription, values, derivatives, options, report);
  report.message = message_of(report, ended);
  return out;
}

}  // namespace lagroid
