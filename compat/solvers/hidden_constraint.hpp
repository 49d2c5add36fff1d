#pragma once
/// Moved to <lagroid/solvers/generating/hidden_constraint.hpp>; this goes with version 0.4.

#include <lagroid/solvers/generating/hidden_constraint.hpp>
