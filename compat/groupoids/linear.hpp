#pragma once
/// Moved to <lagroid/groupoids/groups/linear.hpp>; this goes with version 0.4.

#include <lagroid/groupoids/groups/linear.hpp>
