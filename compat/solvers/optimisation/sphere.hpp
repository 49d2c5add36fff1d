#pragma once
/// Moved to <lagroid/solvers/optimisation/manifolds/sphere.hpp>; this goes with version 0.4.

#include <lagroid/solvers/optimisation/manifolds/sphere.hpp>
