#pragma once
/// Numbers on the command line.

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <string>

namespace lagroid::app {

/// Seeds are below 2^31, so that those that follow one are seeds too.
inline constexpr long largest_seed = 2147483647;

/// Accepts a number for which `good` holds, which never holds for NaN; `what` says which ones those are.
inline CLI::Validator number_that_is(const char* what, bool (*good)(double)) {
  return {[what, good](const std::string& word) {
            double x = 0;
            const bool read = CLI::detail::lexical_cast(word, x);
            return read && good(x) ? std::string() : fmt::format("{} is not {}", word, what);
          },
          ""};
}

inline CLI::Validator finite() {
  return number_that_is("a finite number", [](double x) { return std::isfinite(x); });
}
inline CLI::Validator finite_and_not_negative() {
  return number_that_is("a finite number, zero or positive", [](double x) { return x >= 0 && std::isfinite(x); });
}
inline CLI::Validator positive() {
  return number_that_is("a positive number", [](double x) { return x > 0; });
}

}  // namespace lagroid::app
