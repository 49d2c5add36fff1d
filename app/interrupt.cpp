#include "interrupt.hpp"

namespace lagroid::app {

namespace {

volatile std::sig_atomic_t signal_seen = 0;

extern "C" void note_signal(int) { signal_seen = 1; }

}  // namespace

InterruptGuard::InterruptGuard() {
  signal_seen = 0;
  struct sigaction note {};
  note.sa_handler = note_signal;
  note.sa_flags = int(SA_RESETHAND);  // the next one is not caught
  sigemptyset(&note.sa_mask);
  sigaction(SIGINT, &note, &int_before_);
  sigaction(SIGTERM, &note, &term_before_);
}

InterruptGuard::~InterruptGuard() {
  sigaction(SIGINT, &int_before_, nullptr);
  sigaction(SIGTERM, &term_before_, nullptr);
}

bool InterruptGuard::interrupted() const { return signal_seen != 0; }

}  // namespace lagroid::app
