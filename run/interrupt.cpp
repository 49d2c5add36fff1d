#include <lagroid/run/interrupt.hpp>

#include <unistd.h>

#include <ctime>
#include <mutex>

namespace lagroid {

namespace {

volatile std::sig_atomic_t signal_seen = 0;
volatile std::sig_atomic_t seen_at = 0;  // s

/// Only calls that a signal handler may make.
extern "C" void note_signal(int signal) {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  const auto seconds = std::sig_atomic_t(now.tv_sec);
  if (signal_seen == 0) {
    signal_seen = signal;
    seen_at = seconds;
  } else if (seconds - seen_at > 1) {
    _exit(128 + signal);
  }
}

std::mutex guards_mutex;
int guards = 0;          // that live
bool installed = false;  // note_signal is; it stays after a signal
struct sigaction int_before {};
struct sigaction term_before {};

void put_back() {
  sigaction(SIGINT, &int_before, nullptr);
  sigaction(SIGTERM, &term_before, nullptr);
  installed = false;
}

}  // namespace

InterruptGuard::InterruptGuard() {
  const std::lock_guard lock(guards_mutex);
  ++guards;
  if (installed) return;
  struct sigaction note {};
  note.sa_handler = note_signal;
  note.sa_flags = SA_RESTART;
  sigemptyset(&note.sa_mask);
  sigaction(SIGINT, &note, &int_before);
  sigaction(SIGTERM, &note, &term_before);
  installed = true;
}

InterruptGuard::~InterruptGuard() {
  const std::lock_guard lock(guards_mutex);
  if (--guards == 0 && !interrupted()) put_back();
}

bool InterruptGuard::interrupted() { return signal_seen != 0; }

int InterruptGuard::forget() {
  const std::lock_guard lock(guards_mutex);
  if (guards > 0 || !interrupted()) return 0;
  put_back();
  const int signal = signal_seen;
  signal_seen = 0;
  return signal;
}

}  // namespace lagroid
