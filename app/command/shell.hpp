#pragma once
/// Words of the shell.

#include <string>

namespace lagroid::app {

/// The text as one word.
std::string quoted(const std::string& text);

}  // namespace lagroid::app
