#pragma once
/// Moved to <lagroid/solvers/methods/method.hpp>; this goes with version 0.4.

#include <lagroid/solvers/methods/method.hpp>
