#include <lagroid/run/events/within_step.hpp>

#include <boost/math/tools/toms748_solve.hpp>

#include <cmath>
#include <cstdint>

namespace lagroid {

double root_within(const StepFunction& g, double a, double b, double at_a, double at_b) {
  if (at_a == 0) return a;
  if (at_b == 0) return b;
  double best = a;
  double smallest = std::abs(at_a);
  const auto see = [&](double share, double value) {
    if (std::abs(value) < smallest) {
      smallest = std::abs(value);
      best = share;
    }
    return value;
  };
  see(b, at_b);
  constexpr double spacing = 4e-16;  // of shares
  std::uintmax_t evaluations = 100;
  boost::math::tools::toms748_solve([&](double share) { return see(share, g(share)); }, a, b, at_a, at_b,
                                    [](double left, double right) { return right - left <= spacing; }, evaluations);
  return best;
}

double slope_within(const StepFunction& g, double share) {
  // Truncation and round-off of the differences are of the same small size.
  constexpr double apart = 1.0 / 256;
  if (share >= 2 * apart && share <= 1 - 2 * apart) {
    const double inner = g(share + apart) - g(share - apart);
    const double outer = g(share + 2 * apart) - g(share - 2 * apart);
    return (8 * inner - outer) / (12 * apart);
  }
  const double inwards = share < 0.5 ? apart : -apart;
  const auto at = [&](int k) { return g(share + k * inwards); };
  return (-25 * at(0) + 48 * at(1) - 36 * at(2) + 16 * at(3) - 3 * at(4)) / (12 * inwards);
}

}  // namespace lagroid
