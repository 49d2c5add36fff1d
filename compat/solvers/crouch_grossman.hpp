#pragma once
/// Moved to <lagroid/solvers/newton/crouch_grossman.hpp>; this goes with version 0.4.

#include <lagroid/solvers/newton/crouch_grossman.hpp>
