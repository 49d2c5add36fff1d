// How an iteration ended, in numbers and in words.
#include <lagroid/solvers/control/interior_point.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lagroid {

void InteriorPoint::describe() {
  const KktResidual at = kkt_residual(transcription_, values_, derivatives_, costates_, multipliers_, gradient_);
  report_.stationarity = at.stationarity;
  report_.violation = at.violation;
  report_.complementarity = at.complementarity;
  report_.cost = 0;
  for (long k = 0; k < sizes_.stages; ++k) report_.cost += values_.cost[k][0];
}

/// Where it did not converge: what is violated most, and what to do.
void InteriorPoint::explain() {
  switch (report_.status) {
    case ControlStatus::converged:
      return;
    case ControlStatus::infeasible:
      report_.message =
          "the violation of the constraints has a local minimum here; start from another trajectory, "
          "or relax the constraints that are listed";
      break;
    case ControlStatus::stagnated:
      report_.message =
          "no step is better, though the KKT residual is above the tolerance: scale the cost, give a "
          "tolerance that rounding allows, or start elsewhere";
      break;
    case ControlStatus::not_converged:
      report_.message = fmt::format("not converged in {} iterations; start from another trajectory, or allow more",
                                    options_.max_iterations);
      break;
    case ControlStatus::singular:
      report_.message = "no shift makes the KKT matrix that of a minimum: are constraints given twice?";
      break;
    case ControlStatus::not_finite:
      report_.message = "a cost or constraint of the trajectory to start from is not finite; give another";
      break;
  }
  for (long k = 0; k < sizes_.stages; ++k) {
    for (int i = 0; i < sizes_.equalities_of(k); ++i)
      report_.worst.push_back({k, i, true, std::abs(values_.equality[k][i])});
    for (int i = 0; i < sizes_.inequality; ++i) report_.worst.push_back({k, i, false, values_.inequality[k][i]});
  }
  const auto most = std::min<std::size_t>(5, report_.worst.size());
  std::partial_sort(report_.worst.begin(), report_.worst.begin() + long(most), report_.worst.end(),
                    [](const auto& a, const auto& b) { return a.amount > b.amount; });
  report_.worst.resize(most);
  std::erase_if(report_.worst, [&](const auto& each) { return !(each.amount > options_.tolerance); });
}

}  // namespace lagroid
