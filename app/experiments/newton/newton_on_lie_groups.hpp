#pragma once
/// The experiments of Owren and Welfert, The Newton iteration on Lie groups, section 5, and what lies beyond them.

#include <lagroid/systems/newton_examples.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace lagroid::app {

/// Implicit Euler steps y = z exp(h g(y)) on O(N): both examples, N = smallest..largest, h = 2^-10..2^10, and the
/// random z of the given seeds.
struct NewtonStudy {
  int smallest = 2;
  int largest = 15;
  int seeds = 3;
  std::int64_t first_seed = 0;
};

inline constexpr int least_log2h = -10;
inline constexpr int most_log2h = 10;

/// The paper's three iterations with its tolerance 1e-13 and limit of 100; versions 1 and 2 damped; Ceres; and plain
/// Newton followed by the path.
enum class NewtonMethod { fixed_point, version1, version2, damped1, damped2, ceres, path };
inline constexpr std::array newton_methods{NewtonMethod::fixed_point, NewtonMethod::version1, NewtonMethod::version2,
                                           NewtonMethod::damped1,     NewtonMethod::damped2,  NewtonMethod::ceres,
                                           NewtonMethod::path};
inline constexpr std::array newton_examples{NewtonExample::first, NewtonExample::second};
/// Where they give up.
inline constexpr int paper_iterations = 100;
inline constexpr int damping_halvings = 20;
inline constexpr int ceres_iterations = 200;
int number_of(NewtonExample example);
std::string name_of(NewtonMethod method);

/// One step by one method.
struct NewtonCell {
  NewtonExample example = NewtonExample::first;
  NewtonMethod method = NewtonMethod::fixed_point;
  int n = 0;
  std::uint64_t seed = 0;
  int log2h = 0;
  std::string status;
  bool converged = false;  ///< by the method's own tolerance: the paper's, for the paper's methods
  bool solved = false;     ///< |v - h g(y)| <= 1e-13 (1 + h) was reached
  int iterations = 0;
  double residual = 0;      ///< the least that was reached
  double order = 0;         ///< the paper's ratio of logarithms; NaN where fewer than three iterations converged
  long factorisations = 0;  ///< of Jacobians
  bool plain = false;       ///< of `path`: plain Newton was enough
  bool beyond = false;      ///< the last iterate solves, with a spectral radius of v above pi: beyond the logarithm
};

/// All cells; `done` is told how many of how many starting points are through. Two threads.
std::vector<NewtonCell> run_newton_study(const NewtonStudy& study, const std::function<void(long, long)>& done);

/// Seconds for one iteration on example 1, h = 0.1.
struct IterationTime {
  int n = 0;
  double fixed_point = 0;
  double version1 = 0;
  double version2 = 0;
  double version1_quotients = 0;  ///< with finite differences; 0 where left out
  double version2_quotients = 0;
};
std::vector<IterationTime> time_newton_iterations(int largest);

/// The errors of an implicit integrator over halved steps.
struct IntegratorError {
  std::string problem;
  std::string method;
  int declared_order = 0;
  std::vector<int> steps;
  std::vector<double> errors;
};
std::vector<IntegratorError> measure_implicit_integrators();

}  // namespace lagroid::app
