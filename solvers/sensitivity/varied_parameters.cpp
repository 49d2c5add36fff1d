#include <lagroid/solvers/sensitivity/varied_parameters.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace lagroid::detail {

ParameterPlaces chosen_places(const ParameterPlaces& all, const std::vector<std::string>& names,
                              const std::vector<std::string>& choices) {
  ParameterPlaces out;
  for (const std::string& name : names) {
    const std::size_t before = out.names.size();
    for (std::size_t i = 0; i < all.names.size(); ++i) {
      if (all.names[i] != name && !all.names[i].starts_with(name + ".")) continue;
      if (std::find(out.names.begin(), out.names.end(), all.names[i]) != out.names.end())
        throw std::invalid_argument(fmt::format("parameter {} is named twice", all.names[i]));
      out.names.push_back(all.names[i]);
      out.members.push_back(all.members[i]);
    }
    if (out.names.size() > before) continue;
    if (std::find(choices.begin(), choices.end(), name) != choices.end())
      throw std::invalid_argument(
          fmt::format("parameter {} is a choice of words: nothing is differentiable by it", name));
    throw std::invalid_argument(
        fmt::format("there is no parameter {} that is a number; there are {}", name, fmt::join(all.names, ", ")));
  }
  return out;
}

void require_derivative(const std::string& name, const Eigen::VectorXd& derivative, const Eigen::VectorXd& coarse,
                        const Eigen::VectorXd& fine, double rounding) {
  const double uncertain = 10 * (coarse - fine).norm() + 100 * std::numeric_limits<double>::epsilon() * rounding;
  const double size = std::max(derivative.norm(), fine.norm());
  if ((derivative - fine).norm() <= 1e-3 * size + uncertain || !std::isfinite(uncertain)) return;
  const char* const why =
      derivative.isZero(0)
          ? "the system reads it as a plain number; its formulas must read it by varied<S>(...) "
            "(core/scalars/varied.hpp)"
          : "differences of the step contradict it, as where a step is another one next to this value (moments that "
            "are equal, a branch), or where a part of the formulas reads it as a plain number "
            "(core/scalars/varied.hpp)";
  throw WithoutDerivative(fmt::format("parameter {} carries no derivative: {}", name, why));
}

}  // namespace lagroid::detail
