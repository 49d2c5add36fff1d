#pragma once
/// Duruisseaux and Leok's Figure 1: the four problems, their methods and the competition, and what a step costs.

#include <functional>
#include <string>
#include <vector>

namespace lagroid::app {

struct AcceleratedStudy {
  int instances = 6;
  int first_seed = 1;
  long iterations = 15000;
};

/// How far above the minimum, and what it had cost to come there the first time.
struct Arrival {
  long iterations = -1;  ///< -1: not reached
  long evaluations = 0;  ///< of f, its gradient, or a Hessian times a vector
  double seconds = 0;
};

struct AcceleratedRun {
  std::string problem;
  std::string method;
  int seed = 0;
  Arrival to_8, to_12;  ///< f within 1e-8 and 1e-12 of its minimum
  double gap = 0;       ///< at the end
  std::string outcome;
};

/// A point of the curves that are drawn, of the first instance.
struct AcceleratedPoint {
  std::string problem;
  std::string method;
  long iteration = 0;
  double gap = 0;
};

/// Seconds of an iteration without the gradient of f, and of its parts, least of several.
struct IterationCost {
  long n = 0;
  long m = 0;
  double gradient = 0;  ///< of f, which is taken off
  double ours = 0;      ///< Algorithm 1 in the robust setting
  double descent = 0;   ///< gradient descent with the QR retraction
  double multipliers = 0;
  double qr = 0;
};

struct AcceleratedFindings {
  AcceleratedStudy study;
  std::vector<AcceleratedRun> runs;
  std::vector<AcceleratedPoint> points;
  std::vector<IterationCost> costs;
};

struct AcceleratedMethod {
  std::string name;
  std::string kind;  ///< "paper", "uncapped" or "tuned"
};
const std::vector<AcceleratedMethod>& accelerated_methods();
/// Rayleigh, Brockett, unbalanced and balanced Procrustes.
const std::vector<std::string>& accelerated_problems();

/// Runs every method on every instance. `report(done, all)` is called after each run.
AcceleratedFindings run_accelerated_study(const AcceleratedStudy& study, const std::function<void(long, long)>& report);

/// Of the runs of a method on a problem: the median of `count`, -1 where half of them or more did not arrive.
double median_of(const AcceleratedFindings& findings, const std::string& problem, const std::string& method,
                 const std::function<double(const AcceleratedRun&)>& count);

}  // namespace lagroid::app
