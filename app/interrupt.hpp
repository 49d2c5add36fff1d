#pragma once
/// Ctrl-C and SIGTERM while a run goes on.

namespace lagroid::app {

/// As long as it lives, the first SIGINT or SIGTERM is noted instead of ending the program, and from then on, so that
/// what was computed can be written, only one that comes over a second later ends it (a terminal and `timeout` send
/// theirs to a whole group of processes, so that one may arrive twice). Of several, on any threads, the first sets that
/// up and the last undoes it.
class InterruptGuard {
 public:
  InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
  ~InterruptGuard();
  /// Whether one has come.
  static bool interrupted();
};

}  // namespace lagroid::app
