#pragma once
/// Moved to <lagroid/core/hamiltonian/quadrature_rule.hpp>; this goes with version 0.4.

#include <lagroid/core/hamiltonian/quadrature_rule.hpp>
