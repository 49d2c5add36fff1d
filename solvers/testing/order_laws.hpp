#pragma once
/// The order that a method shows, compared with the order it declares: the slope p in
///
///     |z_h(T) - z(T)| = c h^p + O(h^(p+1)),    h = T / steps.
///
///     const laws::OrderProblem growth{[](int n) { return Eigen::VectorXd::Constant(1, std::pow(1 + 1.0 / n, n)); },
///                                     Eigen::VectorXd::Constant(1, std::exp(1))};
///     std::cout << laws::order_laws({"Euler", 1, false, false, true}, growth);
///
/// Requires an exact end to round-off, and errors that are above it for three numbers of steps.

#include <lagroid/core/testing/law_report.hpp>
#include <lagroid/solvers/methods/method.hpp>

#include <Eigen/Core>

#include <cmath>
#include <functional>
#include <limits>

namespace lagroid::laws {

/// A slope of errors, and what its last two estimates are apart: much, where steps are still too long to show it.
struct MeasuredOrder {
  double order = std::numeric_limits<double>::quiet_NaN();
  double spread = std::numeric_limits<double>::infinity();
};

/// The slope of error(steps), the error after a fixed time by that many steps, as the steps shrink: from the slopes
/// between three numbers of steps, 3 / 2 apart, the last ones that leave the error above the plateau of round-off. The
/// error of a symmetric method is h^p (c_0 + c_1 h^2 + ...), so that slopes approach p like h^2, and are extrapolated.
/// Not a number where fewer than three errors are above the plateau.
template <class Error> MeasuredOrder measure_order(const Error& error, int steps, double plateau = 1e-11) {
  constexpr int finest = 3000;
  MeasuredOrder out;
  double last = error(steps);
  double slope = out.order;
  while (steps < finest) {
    const int more = steps + steps / 2;
    const double ratio = double(more) / steps;
    const double next = error(more);
    if (!(next >= plateau)) break;
    const double next_slope = std::log(last / next) / std::log(ratio);
    out.order = next_slope - (slope - next_slope) / (ratio * ratio - 1);
    if (!std::isnan(slope)) out.spread = std::abs(slope - next_slope);
    slope = next_slope;
    steps = more;
    last = next;
  }
  return out;
}
template <class Error> double measured_order(const Error& error, int steps, double plateau = 1e-11) {
  return measure_order(error, steps, plateau).order;
}

/// A problem with a known end: `end(steps)` is what a method reaches in that many equal steps, `exact` the solution.
struct OrderProblem {
  std::function<Eigen::VectorXd(int steps)> end;
  Eigen::VectorXd exact;
  int coarsest = 20;       ///< steps to begin with
  double plateau = 1e-11;  ///< errors below are round-off: of the method, or of `exact`
};
inline MeasuredOrder measure_order(const OrderProblem& problem) {
  return measure_order([&](int steps) { return (problem.end(steps) - problem.exact).norm(); }, problem.coarsest,
                       problem.plateau);
}
inline double measured_order(const OrderProblem& problem) { return measure_order(problem).order; }

/// The declared order is the observed one, within 0.1. (Asked once: nothing is drawn.)
inline LawReport order_laws(const MethodTraits& method, const OrderProblem& problem, double tolerance = 0.1) {
  LawReport report{"order of " + method.name, {}};
  const auto law = [&](const char* name, double defect) {
    Law asked;
    asked.name = name;
    asked.samples = 1;
    asked.worst = worst({defect});
    asked.tolerance = tolerance;
    report.laws.push_back(asked);
  };
  law("the error falls as declared", std::abs(measured_order(problem) - double(method.order)));
  return report;
}

}  // namespace lagroid::laws
