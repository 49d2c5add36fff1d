#pragma once
/// Times in words.
///
///     std::cout << duration(0.00456);  // 4.56 ms

#include <string>

namespace lagroid {

/// Three digits with a unit, as in "4.56 ms"; "-" where it is not finite.
std::string duration(double seconds);

}  // namespace lagroid
