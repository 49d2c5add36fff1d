#pragma once
/// Numbers from Python, held to the rules of scenes.

#include <lagroid/core/parameter.hpp>

#include <fmt/format.h>

#include <pybind11/pybind11.h>

#include <cmath>
#include <string_view>

namespace lagroid::python {

namespace py = pybind11;

/// x, if the rule holds of it; else ValueError, in the words that a scene gets. `of`: which entries of what is named.
inline double held(std::string_view name, double x, const NumberRule& rule, std::string_view of = "") {
  if (!rule.holds(x)) throw py::value_error(fmt::format("{}: {}must be {}, got {}", name, of, rule.words, x));
  return x;
}
/// The same of a finite number.
inline double finite(std::string_view name, double x, const NumberRule& rule = any_number, std::string_view of = "") {
  if (!std::isfinite(x)) throw py::value_error(fmt::format("{}: must be finite, got {}", name, x));
  return held(name, x, rule, of);
}

}  // namespace lagroid::python
