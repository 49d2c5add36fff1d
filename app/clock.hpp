#pragma once
/// What a computation took.

#include <string>

namespace lagroid::app {

/// Of this thread, s: the wall time of a machine that does nothing else.
double processor_time();

/// Three digits with a unit, as in "4.56 ms"; "-" where it is not finite.
std::string duration(double seconds);

}  // namespace lagroid::app
