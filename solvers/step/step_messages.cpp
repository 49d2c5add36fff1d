#include <lagroid/solvers/step/step_messages.hpp>

#include <fmt/format.h>

namespace lagroid {

std::string step_failure(const StepReport& report, long step, double time, TimeMode mode) {
  const std::string where = fmt::format("step {} (from t = {:.6g})", step, time);
  switch (report.status) {
    case SolveStatus::left_domain:
      if (mode == TimeMode::transformed)
        return fmt::format("{}: the energy of the attraction is not negative here; use mode = \"fixed\"", where);
      if (mode == TimeMode::prescribed)
        return fmt::format(
            "{}: the step is too long: its size would change by more than a factor of two; use a smaller time.step",
            where);
      return fmt::format(
          "{}: the only solution found is on another branch of the discretisation; use a smaller step or "
          "another form of the rotation",
          where);
    case SolveStatus::singular:
      return fmt::format(
          "{}: the step's matrix is singular, the system is not regular here; change the step or the state", where);
    case SolveStatus::not_finite:
      return fmt::format(
          "{}: a number overflowed, became NaN or is too small to keep its digits; use a smaller step, or units in "
          "which masses, lengths and times are nearer one",
          where);
    case SolveStatus::no_step:
      if (mode == TimeMode::prescribed)
        return fmt::format("{}: the time scale of the arrow is not a positive number; use mode = \"fixed\"", where);
      return mode == TimeMode::controlled
                 ? fmt::format("{}: the motion changes too fast for steps of this size; use a smaller time.step", where)
                 : fmt::format(
                       "{}: no positive step size near the last keeps the energy; use another quadrature or "
                       "rotation, time.without_root = \"constant\", or mode = \"controlled\"",
                       where);
    case SolveStatus::degenerate:
      return fmt::format(
          "{}: the discrete energy does not depend on the step size here, so it determines none (a state at rest, a "
          "step so small that only round-off is left, or every step keeps it); use mode = \"fixed\" or \"controlled\", "
          "or a larger step",
          where);
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

std::string tolerance_failure(const StepReport& report, long step, double time, double tolerance, long most) {
  const std::string where = fmt::format("step {} (from t = {:.6g})", step, time);
  switch (report.status) {
    case SolveStatus::not_finite:
      return fmt::format("{}: a number overflowed or became NaN; use a smaller or a larger time.step", where);
    case SolveStatus::no_step:
      return fmt::format("{}: the error stays above time.tolerance = {:g} however small the inner steps; raise it",
                         where, tolerance);
    default:
      return fmt::format(
          "{}: {} inner steps did not reach the next node; raise time.tolerance, or use a smaller time.step", where,
          most);
  }
}

std::string without_root_note(long count, long steps, WithoutRoot instead) {
  return fmt::format("{} of {} steps: the discrete energy determines no positive step size; the size {} was taken",
                     count, steps, instead == WithoutRoot::constant ? "of the first step" : "that the control gives");
}

std::string description(const MethodTraits& method) {
  return fmt::format("{}, order {}{}{}, {}", method.name, method.order, method.symmetric ? ", symmetric" : "",
                     method.symplectic ? ", symplectic" : "", method.explicit_ ? "explicit" : "implicit");
}

}  // namespace lagroid
