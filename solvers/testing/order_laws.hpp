#pragma once
/// The order that a method shows, held to the order it declares.

#include <lagroid/core/testing/law_report.hpp>
#include <lagroid/solvers/method.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace lagroid::laws {

/// A problem with a known end: `end(steps)` is what a method reaches in that many equal steps, `exact` the solution.
struct OrderProblem {
  std::function<Eigen::VectorXd(int steps)> end;
  Eigen::VectorXd exact;
  int coarsest = 20;     ///< steps to begin with
  double floor = 5e-12;  ///< errors below are round-off: of the method, or of `exact`
  int points = 4;        ///< errors, at steps finer by sqrt(2) each, the slope is taken over
};

/// The slope of the error over the step size, between the finest steps whose error is above the floor; not a number
/// where there are fewer than `points` of these.
inline double observed_order(const OrderProblem& problem) {
  std::vector<double> log_h;
  std::vector<double> log_error;
  for (int i = 0; i < 16; ++i) {
    const int steps = int(std::lround(problem.coarsest * std::pow(2.0, 0.5 * i)));
    const double error = (problem.end(steps) - problem.exact).norm();
    if (!(error > problem.floor)) break;
    log_h.push_back(-std::log(double(steps)));
    log_error.push_back(std::log(error));
  }
  const auto n = std::size_t(problem.points);
  if (log_h.size() < n) return std::numeric_limits<double>::quiet_NaN();
  const auto tail = [n](const std::vector<double>& x) {
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(x.data() + (x.size() - n), Eigen::Index(n)));
  };
  const Eigen::VectorXd x = tail(log_h).array() - tail(log_h).mean();
  return x.dot(tail(log_error)) / x.squaredNorm();
}

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
  law("the error falls as declared", std::abs(observed_order(problem) - double(method.order)));
  return report;
}

}  // namespace lagroid::laws
