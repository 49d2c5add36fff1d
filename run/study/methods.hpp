#pragma once
/// Methods by patterns of their names.
///
///     const std::vector<Method> chosen = matching("splitting*,runge-kutta", experiment.methods);
///
/// Errors: UnknownMethod where a pattern fits no method; the message lists those there are.

#include <lagroid/run/study/method.hpp>

#include <stdexcept>
#include <string>
#include <vector>

namespace lagroid {

/// A pattern that fits no method of the scene; the message lists those there are.
class UnknownMethod : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What [time] of a scene holds for the method, as "step = 0.1, steps = 100, method = \"splitting\"".
std::string time_keys(const Method& method, const std::string& grid);

/// Those whose names match one of the patterns, separated by commas ("splitting*,runge-kutta"), in the patterns' order;
/// all where there is none.
std::vector<Method> matching(const std::string& patterns, const std::vector<Method>& all);

}  // namespace lagroid
