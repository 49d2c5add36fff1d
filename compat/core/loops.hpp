#pragma once
/// Moved to <lagroid/core/capabilities/loops.hpp>; this goes with version 0.4.

#include <lagroid/core/capabilities/loops.hpp>
