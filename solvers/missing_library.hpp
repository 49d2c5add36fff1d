#pragma once
/// The exception for what needs a library that this build of lagroid is without; its message names the library and the
/// package to install.

#include <fmt/format.h>

#include <stdexcept>
#include <string_view>

namespace lagroid {

/// What was called needs a library that this build is without.
class MissingLibrary : public std::runtime_error {
 public:
  MissingLibrary(std::string_view asked, std::string_view library, std::string_view package)
      : std::runtime_error(
            fmt::format("{} needs {}, which this build of lagroid is without; install {} and build it again", asked,
                        library, package)) {}
};

}  // namespace lagroid
