#include "interrupt.hpp"

#include <unistd.h>

#include <ctime>

namespace lagroid::app {

namespace {

volatile std::sig_atomic_t signal_seen = 0;
volatile std::sig_atomic_t seen_at = 0;  // s

/// Only calls that a signal handler may make.
extern "C" void note_signal(int signal) {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  const auto seconds = std::sig_atomic_t(now.tv_sec);
  if (signal_seen == 0) {
    signal_seen = 1;
    seen_at = seconds;
  } else if (seconds - seen_at > 1) {
    _exit(128 + signal);
  }
}

}  // namespace

InterruptGuard::InterruptGuard() {
  if (interrupted()) return;  // by a guard before: the handlers are still in place
  struct sigaction note {};
  note.sa_handler = note_signal;
  note.sa_flags = SA_RESTART;
  sigemptyset(&note.sa_mask);
  sigaction(SIGINT, &note, &int_before_);
  sigaction(SIGTERM, &note, &term_before_);
}

InterruptGuard::~InterruptGuard() {
  if (interrupted()) return;
  sigaction(SIGINT, &int_before_, nullptr);
  sigaction(SIGTERM, &term_before_, nullptr);
}

bool InterruptGuard::interrupted() { return signal_seen != 0; }

}  // namespace lagroid::app
