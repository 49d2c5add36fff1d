#pragma once
/// Moved to <lagroid/solvers/integrators/integrator.hpp>; this goes with version 0.4.

#include <lagroid/solvers/integrators/integrator.hpp>

namespace lagroid {

template <DiscreteSystem Sys> using March [[deprecated("March is Integrator")]] = Integrator<Sys>;
using MarchOptions [[deprecated("MarchOptions is IntegratorOptions")]] = IntegratorOptions;
template <DiscreteSystem Sys>
[[deprecated("make_march is make_integrator")]] std::unique_ptr<Integrator<Sys>> make_march(
    const Sys& system, const State<typename Sys::GroupoidType>& initial,
    const ArrowOf<typename Sys::GroupoidType>& configuration, const IntegratorOptions& options) {
  return make_integrator(system, initial, configuration, options);
}

}  // namespace lagroid
