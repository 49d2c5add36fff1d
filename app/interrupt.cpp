#include "interrupt.hpp"

#include <unistd.h>

#include <csignal>
#include <ctime>
#include <mutex>

namespace lagroid::app {

namespace {

volatile std::sig_atomic_t signal_seen = 0;
volatile std::sig_atomic_t seen_at = 0;  // s

std::mutex counting;
long living = 0;  // guards
struct sigaction int_before {};
struct sigaction term_before {};

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
  const std::lock_guard lock(counting);
  // After an interrupt the handlers of the guards before are still in place.
  if (living++ > 0 || interrupted()) return;
  struct sigaction note {};
  note.sa_handler = note_signal;
  note.sa_flags = SA_RESTART;
  sigemptyset(&note.sa_mask);
  sigaction(SIGINT, &note, &int_before);
  sigaction(SIGTERM, &note, &term_before);
}

InterruptGuard::~InterruptGuard() {
  const std::lock_guard lock(counting);
  if (--living > 0 || interrupted()) return;
  sigaction(SIGINT, &int_before, nullptr);
  sigaction(SIGTERM, &term_before, nullptr);
}

bool InterruptGuard::interrupted() { return signal_seen != 0; }

}  // namespace lagroid::app
