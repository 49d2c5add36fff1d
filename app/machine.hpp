#pragma once
/// Where numbers were measured.

#include <string>

namespace lagroid::app {

/// Processor, compiler, instruction set, and the versions of lagroid and of Eigen.
std::string machine();

}  // namespace lagroid::app
