#pragma once
/// From measurements to what an error costs: the cost at which each method comes below it, and the cheapest method.
///
///     const std::optional<Cost> cost = least_cost(findings.runs, Axis::trajectory, 1e-6);
///     if (cost) std::cout << cost->method << ": " << cost->seconds << " s";
///
/// Returns nothing where no run came below the error.

#include <lagroid/run/study/measure.hpp>

#include <optional>
#include <string>
#include <vector>

namespace lagroid {

/// What is wrong with a run.
enum class Axis { trajectory, invariants, constraint };
inline constexpr Axis axes[] = {Axis::trajectory, Axis::invariants, Axis::constraint};
const char* name_of(Axis axis);
double error_of(const Measurement& m, Axis axis);
/// Whether the run got through, and its error, which is relative, is no larger than the motion itself: any other has
/// failed there.
bool is_point(const Measurement& m, Axis axis);

/// What it takes to come below an error.
struct Cost {
  std::string method;
  double step = 0;
  double seconds = 0;
  double evaluations = 0;
};

/// With that method: on the line (in logarithms) between the first run below the error and the one before it. None
/// where no run came below it; the first run itself where there is none before.
std::optional<Cost> cost_of(const std::vector<Measurement>& all, const std::string& method, Axis axis, double error);
/// With the method that takes least time.
std::optional<Cost> least_cost(const std::vector<Measurement>& all, Axis axis, double error);

/// The methods that come below some error, from a tenth down by half decades to `least_error`, at the least of a cost
/// (&Cost::seconds, &Cost::evaluations); from large errors to small ones, each once.
std::vector<std::string> cheapest_methods(const std::vector<Measurement>& all, Axis axis, double Cost::*cost,
                                          double least_error);

/// The methods measured, in order.
std::vector<std::string> methods_of(const std::vector<Measurement>& all);

}  // namespace lagroid
