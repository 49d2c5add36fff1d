#pragma once
/// Moved to <lagroid/core/capabilities/adjoint.hpp>; this goes with version 0.4.

#include <lagroid/core/capabilities/adjoint.hpp>

namespace lagroid {

template <StepDependent Sys> using EitherWay [[deprecated("EitherWay is WithAdjoint")]] = WithAdjoint<Sys>;

}  // namespace lagroid
