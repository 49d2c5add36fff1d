#pragma once
/// Moved to <lagroid/solvers/generating/chord_lagrangian.hpp>; this goes with version 0.4.

#include <lagroid/solvers/generating/chord_lagrangian.hpp>
