#pragma once
/// Moved to <lagroid/groupoids/groups/vector_group.hpp>; this goes with version 0.4.

#include <lagroid/groupoids/groups/vector_group.hpp>
