#pragma once
/// Moved to <lagroid/groupoids/groups/so2.hpp>; this goes with version 0.4.

#include <lagroid/groupoids/groups/so2.hpp>
