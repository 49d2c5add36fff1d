#pragma once
/// Which methods a study runs with which steps, and how often, within its time.
///
///     const Budget budget(60);
///     const auto go_on = [](double) { return true; };
///     const Survey found = survey(experiment, experiment.methods, {}, reference, 5, budget, go_on);

#include <lagroid/run/study/budget.hpp>
#include <lagroid/run/study/measure.hpp>

#include <functional>
#include <string>
#include <vector>

namespace lagroid {

struct Steps {
  /// Given ones; empty: halved from a large one on until errors are those of round-off or a run lasts `longest`
  /// seconds.
  std::vector<double> sizes;
  double longest = 0.25;
};

/// Where a study looks for a reference itself: what of the budget that may take.
inline constexpr double share_of_reference = 1.0 / 3;
/// The experiment, which also stops when the budget is over.
Experiment within(Experiment experiment, const Budget& budget);

/// A method's runs with this step and smaller ones, which were not made.
struct LeftOut {
  std::string method;
  double step = 0;
  std::string why;
};

struct Survey {
  std::vector<Measurement> runs;  ///< method by method, from large steps to small ones
  std::vector<LeftOut> left_out;  ///< for want of time
};

/// Runs the methods in rounds, as many at a time as there are processors, with a look at every node (of long runs, 1e5
/// of them): in each round every method makes one run, the next smaller step. Where a round takes more than a quarter
/// of the time left, methods are given up whose error, expected by their order, another has reached at a tenth of the
/// cost; where it does not fit into that time, those that promise most make their runs. Looking ends when two thirds of
/// the budget are over. Then every run is timed alone, without looks: `repetitions` times, interleaved, first those
/// near the least cost of their errors, then the others, as long as there is time. `report` is called with the
/// part of the budget that is spent, and returns whether to go on.
Survey survey(const Experiment& experiment, const std::vector<Method>& methods, const Steps& steps,
              const Reference& reference, int repetitions, const Budget& budget,
              const std::function<bool(double spent)>& report);

}  // namespace lagroid
