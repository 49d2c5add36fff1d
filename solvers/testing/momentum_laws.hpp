#pragma once
/// Momentum conservation as a property that any system with `quantities()` runs by naming itself.

#include <lagroid/core/testing/property.hpp>
#include <lagroid/solvers/integrator.hpp>
#include <lagroid/solvers/newton_step.hpp>

#include <cmath>
#include <memory>
#include <vector>

namespace lagroid::laws {

/// For random initial states: every quantity promised as conserved stays where it began over `steps` steps, within
/// `tolerance` relative to its size. `draw()` returns a State; a step that fails counts as a defect of infinity.
template <DiscreteSystem Sys, class Draw>
LawReport momentum_laws(const Sys& system, const Draw& draw, int steps = 50, double tolerance = 1e-12) {
  using G = typename Sys::GroupoidType;
  LawReport report{"conserved quantities", {}};
  for (const auto& quantity : system.quantities()) {
    if (quantity.promise != Promise::conserved) continue;
    report.laws.push_back(check_law(quantity.name, tolerance, [&] {
      const State<G> start = draw();
      Integrator<Sys> integrator(system, start, system.groupoid.unit(start.object),
                                 std::make_unique<NewtonStep<Sys>>());
      std::vector<double> first(quantity.components.size());
      std::vector<double> now(quantity.components.size());
      double size = 1e-3;
      double largest = 0;
      for (int k = 0; k <= steps; ++k) {
        if (k > 0 && !integrator.advance().converged()) return std::numeric_limits<double>::infinity();
        if (k == 0 && quantity.needs_step) continue;
        quantity.evaluate(integrator.point(), now.data());
        if (k == (quantity.needs_step ? 1 : 0)) first = now;
        double norm = 0;
        for (std::size_t i = 0; i < now.size(); ++i) {
          largest = worst({largest, std::abs(now[i] - first[i])});
          norm += now[i] * now[i];
        }
        size = std::max({size, std::sqrt(norm), quantity.size ? quantity.size(integrator.point()) : 0.0});
      }
      return largest / size;
    }));
  }
  return report;
}

}  // namespace lagroid::laws
