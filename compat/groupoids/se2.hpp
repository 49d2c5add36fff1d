#pragma once
/// Moved to <lagroid/groupoids/groups/se2.hpp>; this goes with version 0.4.

#include <lagroid/groupoids/groups/se2.hpp>
