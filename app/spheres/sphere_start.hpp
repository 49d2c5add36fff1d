#pragma once
/// Where a motion on (T*S^2)^k starts.

#include "sphere_system.hpp"

namespace lagroid::app {

/// [initial] of a scene, in that form: `directions`, or `theta` and `phi`; `angular_velocities` or `momenta`, by
/// default zero, which are tangent, or made so where `project_velocities` says it.
/// The keys of [initial] for a system that has these forms.
Table sphere_start_table(const std::vector<SphereForm>& forms);
SphereIntegrator::Points read_start(const Section& scene, const SphereSystem& system, SphereForm form);

}  // namespace lagroid::app
