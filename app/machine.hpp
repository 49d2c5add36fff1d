#pragma once
/// Where numbers were measured.

#include <string>

namespace lagroid::app {

/// Compiler, instruction set, and the versions of lagroid and of Eigen.
std::string program();
/// Processor, compiler, instruction set, and the versions of lagroid and of Eigen.
std::string machine();

}  // namespace lagroid::app
