#pragma once
/// Moved to <lagroid/groupoids/groups/orthogonal.hpp>; this goes with version 0.4.

#include <lagroid/groupoids/groups/orthogonal.hpp>
