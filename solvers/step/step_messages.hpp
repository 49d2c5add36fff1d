#pragma once
/// Sentences for the user of a scene: why a step failed and what to change, how many steps had no root, what a method
/// is.
///
///     const std::string why = step_failure({SolveStatus::singular}, 7, 0.6, TimeMode::fixed);

#include <lagroid/solvers/integrators/integrator.hpp>
#include <lagroid/solvers/methods/method.hpp>
#include <lagroid/solvers/step/step_solver.hpp>

#include <string>

namespace lagroid {

/// A sentence on a step that failed: its number, the time before it (s), and what to do.
std::string step_failure(const StepReport& report, long step, double time, TimeMode mode);
/// The same of a node that inner steps by a tolerance were to reach, `most` of them.
std::string tolerance_failure(const StepReport& report, long step, double time, double tolerance, long most);
/// A note on steps whose size is not that of the mode.
std::string without_root_note(long count, long steps, WithoutRoot instead);
/// What a method declares of itself.
std::string description(const MethodTraits& method);

}  // namespace lagroid
