#pragma once
/// How an iterative solve ended: a typed status in place of an exception, because a step that fails is an outcome of a
/// numerical method and not a mistake of the program.
///
///     const SolveStatus status = SolveStatus::no_step;
///     if (status != SolveStatus::converged) std::cerr << to_string(status) << '\n';

#include <string_view>

namespace lagroid {

/// Only `converged` lets a caller go on; whoever integrates a trajectory keeps its last state on every other outcome.
enum class SolveStatus {
  converged,        ///< residual as small as the solver promises (its options say how small)
  stagnated,        ///< the residual stopped falling above that floor
  singular,         ///< the matrix of the step is singular: the system is not regular here ([G] Def. 3.5)
  left_domain,      ///< converged, but on another branch of the discretisation or outside the retraction's domain
  not_finite,       ///< a NaN or an infinity appeared, or numbers too small to keep their digits
  not_converged,    ///< the iteration limit was reached
  ill_conditioned,  ///< near a solution, but the method's own arithmetic cannot come closer; another method can
  no_step,          ///< no positive step size does what it should
  degenerate,       ///< what is to determine the step size does not depend on it
};

constexpr std::string_view to_string(SolveStatus status) {
  switch (status) {
    case SolveStatus::converged:
      return "converged";
    case SolveStatus::stagnated:
      return "stagnated";
    case SolveStatus::singular:
      return "singular";
    case SolveStatus::left_domain:
      return "left_domain";
    case SolveStatus::not_finite:
      return "not_finite";
    case SolveStatus::not_converged:
      return "not_converged";
    case SolveStatus::ill_conditioned:
      return "ill_conditioned";
    case SolveStatus::no_step:
      return "no_step";
    case SolveStatus::degenerate:
      return "degenerate";
  }
  return "unknown";
}

}  // namespace lagroid
