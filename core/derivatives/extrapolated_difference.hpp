#pragma once
/// f'(0) of a function of a number with values in R^n, by central differences of widths h, h/2, h/4, ... extrapolated
/// to none (Richardson): a difference is f'(0) + c_1 h^2 + c_2 h^4 + ...
///
///     const auto by = extrapolated_difference([](double x) { return Eigen::VectorXd::Constant(1, std::sin(x)); },
///     1e-2); std::cout << by->value << ", the last extrapolation changed it by " << by->correction << '\n';
///
/// Returns none where f, which may return an optional, has no value at one of the places. Requires two widths or more
/// for a correction; it is zero of one. Nothing throws but what f does.

#include <Eigen/Core>

#include <optional>
#include <utility>
#include <vector>

namespace lagroid {

struct ExtrapolatedDifference {
  Eigen::VectorXd value;
  Eigen::VectorXd correction;  ///< by the last extrapolation
};

template <class F>
std::optional<ExtrapolatedDifference> extrapolated_difference(const F& f, double width, int widths = 3) {
  std::vector<Eigen::VectorXd> row;  // of the widths so far, each combined with those after it
  for (int level = 0; level < widths; ++level, width /= 2) {
    const std::optional<Eigen::VectorXd> above = f(width), below = f(-width);
    if (!above || !below) return std::nullopt;
    Eigen::VectorXd next = (*above - *below) / (2 * width);
    double power = 4;
    for (Eigen::VectorXd& each : row) {
      const Eigen::VectorXd better = next + (next - each) / (power - 1);
      each = std::exchange(next, better);
      power *= 4;
    }
    row.push_back(next);
  }
  const Eigen::VectorXd& before = row[std::size_t(widths > 1 ? widths - 2 : 0)];
  return ExtrapolatedDifference{row.back(), row.back() - before};
}

}  // namespace lagroid
