#pragma once
/// Long runs: the largest drift of every conserved quantity, and the slope of a bounded one.

#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace lagroid {

struct Watched {
  double drift = 0;  ///< largest deviation over the size of its terms at first: `size`, its norm where it has none
  double first_quarter = 0;  ///< largest deviation in the first and the last quarter
  double last_quarter = 0;
  double trend = 0;  ///< what the least-squares line through a component rises over the run, at most, over that size
};

/// Runs `steps` steps and watches every quantity of the system, and `more`; empty when a step fails.
template <DiscreteSystem Sys>
std::map<std::string, Watched> watch(const Sys& system, const State<typename Sys::GroupoidType>& start, long steps,
                                     const std::vector<Quantity<Sys>>& more = {}) {
  auto quantities = system.quantities();
  quantities.insert(quantities.end(), more.begin(), more.end());
  std::map<std::string, Watched> out;
  std::vector<std::vector<double>> first(quantities.size());
  std::vector<double> size(quantities.size());
  std::vector<std::vector<double>> moment(quantities.size());  // sums of deviation times centred time
  std::vector<double> now;
  FixedStepIntegrator<Sys> integrator(system, start, system.groupoid.unit(start.object),
                                      std::make_unique<NewtonStep<Sys>>());
  for (long k = 0; k <= steps; ++k) {
    if (k > 0 && !integrator.advance().converged()) return {};
    auto point = integrator.point();
    point.state.momentum = tangent_momentum(system, point.state);
    for (std::size_t i = 0; i < quantities.size(); ++i) {
      if (quantities[i].needs_step && k == 0) continue;
      now.resize(quantities[i].components.size());
      quantities[i].evaluate(point, now.data());
      if (first[i].empty()) {
        first[i] = now;
        size[i] = quantities[i].size ? quantities[i].size(point)
                                     : Eigen::Map<const Eigen::VectorXd>(now.data(), Eigen::Index(now.size())).norm();
        moment[i].resize(now.size());
      }
      double deviation = 0;
      for (std::size_t j = 0; j < now.size(); ++j) {
        deviation += (now[j] - first[i][j]) * (now[j] - first[i][j]);
        moment[i][j] += (now[j] - first[i][j]) * (double(k) - 0.5 * double(steps));
      }
      if (!std::isfinite(deviation)) return {};
      auto& w = out[quantities[i].name];
      deviation = std::sqrt(deviation) / size[i];
      w.drift = std::max(w.drift, deviation);
      if (4 * k < steps) w.first_quarter = std::max(w.first_quarter, deviation);
      if (4 * k > 3 * steps) w.last_quarter = std::max(w.last_quarter, deviation);
      // Sum of squares of the centred times: steps^3 / 12.
      if (k == steps)
        for (const double m : moment[i])
          w.trend = std::max(w.trend, 12 * std::abs(m) / (double(steps) * double(steps) * size[i]));
    }
  }
  return out;
}

}  // namespace lagroid
