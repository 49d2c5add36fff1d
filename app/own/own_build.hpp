#pragma once
/// Programs of one's own, compiled from a source into the user's cache, once for each text of it.
///
///     const std::filesystem::path program = built_from("dido.cpp", OwnPart::steps, [] { std::cerr << "compiles\n"; });
///
/// Errors: BuildRefused, with lines of the compiler's.

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>

namespace lagroid::app {

/// Something that keeps a program from being built. The message may have lines of the compiler's.
class BuildRefused : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// How much of a program (own_program.hpp).
enum class OwnPart { steps, methods, laws, derivatives };

/// The program that a C++ source makes, compiled where the cache does not hold it: under the text that the preprocessor
/// leaves of it, the compiler's flags and the library. The cache is $XDG_CACHE_HOME/lagroid, or ~/.cache/lagroid, which
/// must be a folder of the user's own that nobody else may enter. `told` is called before the compiler is, so that a
/// message can be printed. Throws BuildRefused.
std::filesystem::path built_from(const std::filesystem::path& source, OwnPart part, const std::function<void()>& told);

}  // namespace lagroid::app
