#pragma once
/// The processor time of the calling thread, for measurements that other programs on the machine must not disturb.

#include <ctime>

namespace lagroid {

/// Of this thread, s: the wall time of a machine that does nothing else.
inline double processor_time() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

}  // namespace lagroid
