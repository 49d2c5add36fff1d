#pragma once
/// Moved to <lagroid/solvers/step/ceres_step.hpp>; this goes with version 0.4.

#include <lagroid/solvers/step/ceres_step.hpp>
