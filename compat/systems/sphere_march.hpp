#pragma once
/// Moved to <lagroid/systems/spheres/sphere_integrator.hpp>; this goes with version 0.4.

#include <lagroid/systems/spheres/sphere_integrator.hpp>

namespace lagroid {

using SphereMarch [[deprecated("SphereMarch is SphereIntegrator")]] = SphereIntegrator;
using SphereMarchOptions [[deprecated("SphereMarchOptions is SphereIntegratorOptions")]] = SphereIntegratorOptions;
template <class F>
[[deprecated("march_on_spheres is integrator_on_spheres")]] std::unique_ptr<SphereIntegrator> march_on_spheres(
    F field, const SphereIntegrator::Points& start, const SphereIntegratorOptions& options) {
  return integrator_on_spheres(std::move(field), start, options);
}

}  // namespace lagroid
