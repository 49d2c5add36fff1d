#pragma once
/// By which method a motion on (T*S^2)^k goes on.

#include "sphere_system.hpp"

#include <lagroid/run/study/method.hpp>

#include <vector>

namespace lagroid::app {

/// [time] of a scene, its step apart: method, form, tolerance.
SphereMarchOptions read_sphere_time(const Section& scene, const SphereSystem& system);

/// All that it would accept: the system's own, and every Lie group method in every form; those with an error estimate
/// also with controlled steps.
std::vector<Method> sphere_methods(const SphereSystem& system);

/// Whether the method keeps to the spheres.
bool keeps_spheres(const SphereMarchOptions& options);

}  // namespace lagroid::app
