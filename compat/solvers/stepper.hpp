#pragma once
/// Moved to <lagroid/solvers/step/step_predictor.hpp>; this goes with version 0.4.

#include <lagroid/solvers/step/step_predictor.hpp>

namespace lagroid {

template <DiscreteSystem Sys> using Stepper [[deprecated("Stepper is StepPredictor")]] = StepPredictor<Sys>;

}  // namespace lagroid
