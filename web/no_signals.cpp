/// Signals in a browser, which has none: a worker that shall end is ended from outside.

#include <lagroid/run/interrupt.hpp>

namespace lagroid {

bool InterruptGuard::interrupted() { return false; }

}  // namespace lagroid
