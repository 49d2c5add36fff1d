#pragma once
/// Words of the shell.
///
///     std::cout << "lagroid run " << quoted(file);  // whatever the name of the file contains

#include <string>

namespace lagroid::app {

/// The text as one word.
std::string quoted(const std::string& text);

}  // namespace lagroid::app
