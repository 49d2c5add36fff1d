#pragma once
/// Moved to <lagroid/core/scalars/second_jet.hpp>; this goes with version 0.4.

#include <lagroid/core/scalars/second_jet.hpp>
