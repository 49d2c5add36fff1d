#include <lagroid/run/events/within_step.hpp>

#include <boost/math/tools/toms748_solve.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace lagroid {

namespace {

/// Of the differences that are slopes: truncation and round-off are of the same small size.
constexpr double slope_spacing = 1.0 / 256;

double finite_value(const StepFunction& g, double share) {
  const double value = g(share);
  // A pole may give an infinite number, whose sign tells what it has to.
  if (std::isnan(value)) throw NoNumber{share};
  return value;
}

/// Where a function with one valley is lowest, by golden sections: at a kink, to the spacing of numbers, where methods
/// that fit parabolas stop at its root.
double lowest_within(const StepFunction& g, double low, double high) {
  constexpr double spacing = 1e-15;
  constexpr double golden = 0.6180339887498949;
  double left = high - golden * (high - low), right = low + golden * (high - low);
  double at_left = g(left), at_right = g(right);
  while (high - low > spacing) {
    if (at_left < at_right) {
      high = std::exchange(right, left);
      at_right = at_left;
      left = high - golden * (high - low);
      at_left = g(left);
    } else {
      low = std::exchange(left, right);
      at_left = at_right;
      right = low + golden * (high - low);
      at_right = g(right);
    }
  }
  return 0.5 * (low + high);
}

}  // namespace

RootInStep root_within(const StepFunction& g, double a, double b, double at_a, double at_b) {
  if (at_a == 0) return {a, false};
  if (at_b == 0) return {b, false};
  constexpr double spacing = 4e-16;  // of shares
  std::uintmax_t evaluations = 200;
  const auto [left, right] =
      boost::math::tools::toms748_solve([&](double share) { return finite_value(g, share); }, a, b, at_a, at_b,
                                        [](double low, double high) { return high - low <= spacing; }, evaluations);
  if (left == right) return {left, false};
  const double at_left = left == a ? at_a : finite_value(g, left);
  const double at_right = right == b ? at_b : finite_value(g, right);
  // What a smooth function changes by between neighbours is round-off.
  constexpr double share_of_a_jump = 1e-3;
  const bool is_zero = at_left == 0 || at_right == 0;
  const bool is_jump = !is_zero && std::abs(at_right - at_left) > share_of_a_jump * std::abs(at_b - at_a);
  return {std::abs(at_left) < std::abs(at_right) ? left : right, is_jump};
}

double slope_within(const StepFunction& g, double share) {
  if (share >= 2 * slope_spacing && share <= 1 - 2 * slope_spacing) {
    const double inner = finite_value(g, share + slope_spacing) - finite_value(g, share - slope_spacing);
    const double outer = finite_value(g, share + 2 * slope_spacing) - finite_value(g, share - 2 * slope_spacing);
    return (8 * inner - outer) / (12 * slope_spacing);
  }
  const double inwards = share < 0.5 ? slope_spacing : -slope_spacing;
  const auto at = [&](int k) { return finite_value(g, share + k * inwards); };
  return (-25 * at(0) + 48 * at(1) - 36 * at(2) + 16 * at(3) - 3 * at(4)) / (12 * inwards);
}

double turn_within(const StepFunction& g, double slope_at_0, double slope_at_1) {
  const double turn =
      root_within([&](double share) { return slope_within(g, share); }, 0, 1, slope_at_0, slope_at_1).share;
  // Of a smooth function the slope changes little over the differences that make it; a kink it smooths over.
  constexpr double around = 4 * slope_spacing;
  const double low = std::max(0.0, turn - around), high = std::min(1.0, turn + around);
  const double change = slope_within(g, high) - slope_within(g, low);
  if (std::abs(change) <= 0.25 * std::abs(slope_at_1 - slope_at_0)) return turn;
  const double sign = slope_at_1 > slope_at_0 ? 1 : -1;
  return lowest_within([&](double share) { return sign * finite_value(g, share); }, low, high);
}

bool is_rounding_within(const StepFunction& g) {
  constexpr int parts = 8;
  std::array<double, parts + 1> values;
  for (int i = 0; i <= parts; ++i) values[std::size_t(i)] = finite_value(g, double(i) / parts);
  const double bend = values[0] - 2 * values[parts / 2] + values[parts];
  // Differences of fourth order of an eighth of the step are a thousandth of those of second order of a half, of a
  // smooth function; of rounding they are larger.
  double roughness = 0;
  for (std::size_t i = 2; i + 2 <= parts; ++i)
    roughness = std::max(
        roughness, std::abs(values[i - 2] - 4 * values[i - 1] + 6 * values[i] - 4 * values[i + 1] + values[i + 2]));
  constexpr double smooth = 0.05;
  return roughness >= smooth * std::abs(bend);
}

}  // namespace lagroid
