#pragma once
/// Methods by the patterns of their names.

#include <lagroid/run/study/method.hpp>

#include <stdexcept>
#include <string>
#include <vector>

namespace lagroid {

/// A pattern that no method of the scene has; says which there are.
class UnknownMethod : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What [time] of a scene holds for the method, as "step = 0.1, steps = 100, method = \"splitting\"".
std::string time_keys(const Method& method, const std::string& grid);

/// Those whose names match one of the patterns, separated by commas ("splitting*,runge-kutta"), in the patterns' order;
/// all where there is none.
std::vector<Method> matching(const std::string& patterns, const std::vector<Method>& all);

}  // namespace lagroid
