#pragma once
/// Where a motion on (T*S^2)^k starts.

#include "sphere_system.hpp"

namespace lagroid::app {

/// The keys of [initial] for a system that has these forms.
Table sphere_start_table(const std::vector<SphereForm>& forms);

/// A start in the form in which it is given.
struct GivenSphereStart {
  SphereIntegrator::Points z;
  SphereForm form;
};
/// [initial] of a scene: `directions`, or `theta` and `phi`; `angular_velocities` or `momenta`, by default zero (in the
/// form that is asked for), which are tangent, or made so where `project_velocities` says it.
GivenSphereStart read_given_start(const Section& scene, const SphereSystem& system, SphereForm form);
/// The same in that form.
SphereIntegrator::Points read_start(const Section& scene, const SphereSystem& system, SphereForm form);

}  // namespace lagroid::app
