#pragma once
/// Moved to <lagroid/systems/spheres/sphere_integrator.hpp>; this goes with version 0.4.

#include <lagroid/systems/spheres/sphere_integrator.hpp>
