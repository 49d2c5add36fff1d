#pragma once
/// All runs of a problem up to one time, and what is read off them.

#include "problems/problem.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace peers {

struct Run {
  std::size_t method;  ///< its index in the problem
  double setting = 0;  ///< step or tolerance
  long steps = 0;
  double error = 0;
  double drift = 0;
  double seconds = 0;  ///< processor time: median of the repetitions
  double spread = 0;   ///< the distance of the quartiles over the median
  std::string failure = {};
};

struct Study {
  double end = 0;
  Reference reference;
  std::vector<Run> runs;
  double floor = 0;  ///< the smallest error that any run reaches
};

/// How long a run and how many of them.
struct Effort {
  double longest;   ///< s: no run is begun that would take longer
  int repetitions;  ///< of runs below 0.3 s
};
/// `brief`: to see the shape of things.
inline Effort effort_for(double end, bool brief) {
  if (brief) return {end < 1e3 ? 0.02 : 0.2, 1};
  return {end < 1e3 ? 0.5 : 2.5, 3};
}

/// Every method with ever finer settings until its error falls no more or its runs get too long; then the repetitions,
/// in an order drawn at random.
Study study(const Problem& problem, double end, const Effort& effort);

/// What an error costs a method: seconds and setting on the line (in logarithms) between the last run above it and the
/// next. Infinite where no run gets there. What lies beyond the method's best run is left out.
struct Cost {
  double seconds;
  double setting;
};
Cost cost(const Study& study, std::size_t method, double error);

/// The cheapest of the methods that `eligible` picks.
struct Cheapest {
  Cost cost;
  std::size_t method = 0;
};
Cheapest cheapest(const Problem& problem, const Study& study, double error,
                  const std::function<bool(const Method&)>& eligible);

/// 1e-2, 1e-3, ... down to ten times the floor.
std::vector<double> error_levels(const Study& study);

}  // namespace peers
