#pragma once
/// The bounds of the numbers that a rule lets pass.

#include <lagroid/core/parameter.hpp>

#include <optional>

namespace lagroid::app {

struct Bound {
  double value;
  bool excluded;
};
struct Bounds {
  std::optional<Bound> least;
  std::optional<Bound> most;
};

/// A rule is a function and a few words; its bounds are found by asking it, so that nobody states them twice. They are
/// those of the interval around the first number that it lets pass of 0, 1, 2, ... 9 and these times powers of ten, of
/// either sign; none where it lets none of them pass.
Bounds bounds_of(const NumberRule& rule);

}  // namespace lagroid::app
