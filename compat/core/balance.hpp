#pragma once
/// Moved to <lagroid/core/capabilities/balance.hpp>; this goes with version 0.4.

#include <lagroid/core/capabilities/balance.hpp>
