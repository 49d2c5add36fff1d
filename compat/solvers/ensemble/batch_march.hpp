#pragma once
/// Moved to <lagroid/solvers/ensemble/batch_integrator.hpp>; this goes with version 0.4.

#include <lagroid/solvers/ensemble/batch_integrator.hpp>

namespace lagroid {

template <DiscreteSystem Sys, int W>
using BatchMarch [[deprecated("BatchMarch is BatchIntegrator")]] = BatchIntegrator<Sys, W>;

}  // namespace lagroid
