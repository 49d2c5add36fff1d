#pragma once
/// Moved to <lagroid/core/derivatives/arrow_frame.hpp>; this goes with version 0.4.

#include <lagroid/core/derivatives/arrow_frame.hpp>
