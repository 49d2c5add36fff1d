#pragma once
/// Moved to <lagroid/core/scalars/batch.hpp>; this goes with version 0.4.

#include <lagroid/core/scalars/batch.hpp>
