#include "simulation.hpp"

namespace lagroid::app {

TimeGrid read_time(const Section& scene) {
  const Section time = scene.section("time", "step and steps, or duration and steps");
  constexpr long most = 2'000'000'000;
  TimeGrid grid;
  const bool has_duration = time.has("duration");
  const bool has_step = time.has("step");
  if (has_duration && has_step) time.fail("duration", "give step or duration, not both (steps goes with either)");
  grid.steps = time.integer("steps", 1, most);
  grid.step = has_duration ? time.number("duration", positive) / double(grid.steps) : time.number("step", positive);
  return grid;
}

StepperChoice read_stepper(const Section& solver) {
  StepperChoice choice;
  if (solver.choice_or("method", "newton", {"newton", "ceres"}) == "ceres") choice.method = StepMethod::ceres;
  if (solver.has("max_iterations")) choice.options.max_iterations = int(solver.integer("max_iterations", 1, 100000));
  choice.options.tolerance = solver.number_or("tolerance", 0, nonnegative);
  return choice;
}

long read_every(const Section& scene, const RunContext& context) {
  const long every = scene.section_or_empty("output").integer_or("every", 1, 1, 1'000'000'000);
  return context.record ? every : 0;
}

std::string step_failure(const StepReport& report, long step, double time) {
  const std::string where = fmt::format("step {} (from t = {:.6g})", step, time);
  switch (report.status) {
    case SolveStatus::left_domain:
      return fmt::format(
          "{}: the only solution found is on another branch of the discretisation; use a smaller step or "
          "another form of the rotation",
          where);
    case SolveStatus::singular:
      return fmt::format(
          "{}: the step's matrix is singular, the system is not regular here; change the step or the state", where);
    case SolveStatus::not_finite:
      return fmt::format("{}: a number overflowed or became NaN; use a smaller step", where);
    case SolveStatus::not_converged:
      return fmt::format(
          "{}: no convergence after {} iterations (residual {:.3g}); use a smaller step or raise "
          "solver.max_iterations",
          where, report.iterations, report.residual);
    default:
      return fmt::format(
          "{}: the iteration stagnated at residual {:.3g}; no solution near this state, use a smaller step", where,
          report.residual);
  }
}

}  // namespace lagroid::app
