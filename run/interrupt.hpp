#pragma once
/// Ctrl-C and SIGTERM while a run goes on: the first is noted, so that the run can end its step and write its files.
///
///     const InterruptGuard guard;
///     while (!InterruptGuard::interrupted() && advance()) {
///     }

#include <csignal>

namespace lagroid {

/// As long as one lives, the first SIGINT or SIGTERM is noted instead of ending the program, and from then on, so that
/// what was computed can be written, only one that comes over a second later ends it (a terminal and `timeout` send
/// theirs to a whole group of processes, so that one may arrive twice). Guards nest, and live on several threads: what
/// handled signals before is put back with the last.
class InterruptGuard {
 public:
  InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
  ~InterruptGuard();
  /// Whether one has come.
  static bool interrupted();
  /// For a host that goes on after an interrupt: where no guard lives any more, puts back what handled signals before,
  /// and forgets the one that came. Returns it; 0: none came, or a guard lives.
  static int forget();
};

}  // namespace lagroid
