#pragma once
/// The systems of the library (systems/systems.cmake).

#include "../scenes/system_module.hpp"

#include <vector>

namespace lagroid::app {

/// In the order in which they are listed to users.
std::vector<const SystemModule*> library_systems();

}  // namespace lagroid::app
