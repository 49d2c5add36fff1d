#pragma once
/// Moved to <lagroid/core/derivatives/second_derivatives.hpp>; this goes with version 0.4.

#include <lagroid/core/derivatives/second_derivatives.hpp>
