#pragma once
/// Moved to <lagroid/core/derivatives/gradient_check.hpp>; this goes with version 0.4.

#include <lagroid/core/derivatives/gradient_check.hpp>
