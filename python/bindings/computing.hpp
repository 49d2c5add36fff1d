#pragma once
/// Long computations called from Python.

#include <lagroid/run/interrupt.hpp>

#include <pybind11/pybind11.h>

#include <csignal>
#include <optional>
#include <utility>

namespace lagroid::python {

namespace py = pybind11;

/// What `compute()` returns, computed without the interpreter's lock. Ctrl-C meanwhile is noted (InterruptGuard), and
/// `interrupted` says so. SIGTERM goes to whoever handled it before, afterwards.
template <class F> auto computing(const F& compute, bool& interrupted) {
  struct Signals {
    explicit Signals(bool& seen) : interrupted(seen) {}
    ~Signals() {
      guard.reset();
      const int signal = lagroid::InterruptGuard::forget();
      interrupted = signal == SIGINT;
      if (signal != 0 && !interrupted) std::raise(signal);
    }
    bool& interrupted;
    std::optional<lagroid::InterruptGuard> guard{std::in_place};
  };
  const Signals signals(interrupted);
  const py::gil_scoped_release unlocked;
  return compute();
}

/// The same, raising KeyboardInterrupt after Ctrl-C.
template <class F> auto computing(const F& compute) {
  bool interrupted = false;
  auto result = computing(compute, interrupted);
  if (interrupted) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw py::error_already_set();
  }
  return result;
}

}  // namespace lagroid::python
