#pragma once
/// Moved to <lagroid/groupoids/groups/matrix_group.hpp>; this goes with version 0.4.

#include <lagroid/groupoids/groups/matrix_group.hpp>
