#pragma once
/// Moved to <lagroid/core/capabilities/split_system.hpp>; this goes with version 0.4.

#include <lagroid/core/capabilities/split_system.hpp>
