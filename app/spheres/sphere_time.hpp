#pragma once
/// By which method a motion on (T*S^2)^k goes on.

#include "sphere_system.hpp"

#include <lagroid/run/study/method.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace lagroid::app {

/// The keys of [time].
Table sphere_time_table(const SphereEntry& entry);
/// `method` of [time]: one of the system's own, or a Lie group method.
std::string read_sphere_method(const Section& time, const SphereEntry& entry);
/// The system's own method of that name; null where it is one for Lie groups.
const DeclaredMethod* own_method(const SphereEntry& entry, std::string_view name);
/// [time] of a scene, its step apart: method, form, tolerance.
SphereIntegratorOptions read_sphere_time(const Section& scene, const SphereEntry& entry, const SphereSystem& system);

/// All that it would accept: the system's own, and every Lie group method in every form; those with an error estimate
/// also with controlled steps.
std::vector<Method> sphere_methods(const SphereEntry& entry, const SphereSystem& system);

/// Whether the method keeps to the spheres.
bool keeps_spheres(const SphereIntegratorOptions& options);

}  // namespace lagroid::app
