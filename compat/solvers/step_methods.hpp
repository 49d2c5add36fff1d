#pragma once
/// Moved to <lagroid/solvers/step/step_methods.hpp>; this goes with version 0.4.

#include <lagroid/solvers/step/step_methods.hpp>
