#include <lagroid/solvers/control/optimality/curvature.hpp>

#include <algorithm>
#include <cstddef>

namespace lagroid {

Curvature curvature_of(StageKkt& kkt, const StageDerivatives& derivatives, const StageRows& multipliers,
                       const StageRows& slacks, StageRows& sigma, StageRows& dual) {
  constexpr double least_pivot = 1e-18;
  constexpr double idle = 1e-6;    // sigma of what is nowhere near to acting
  constexpr double least = 1e-11;  // a pivot that is smaller would leave no digits of those after it
  const auto of_it = [&](std::size_t i) { return multipliers.numbers()[i] / slacks.numbers()[i]; };
  set_all(dual, 0);
  for (std::size_t i = 0; i < sigma.numbers().size(); ++i)
    sigma.numbers()[i] = of_it(i) < idle ? -std::max(of_it(i), least) : of_it(i);
  kkt.assemble(derivatives, sigma);
  const StageKkt::Inertia without_idle = kkt.factor(0, dual);
  if (without_idle.smallest > least_pivot && without_idle.negative == kkt.equalities())
    return Curvature::strict_minimum;

  for (std::size_t i = 0; i < sigma.numbers().size(); ++i) sigma.numbers()[i] = of_it(i);
  kkt.assemble(derivatives, sigma);
  const StageKkt::Inertia inertia = kkt.factor(1e-8 * largest_entry(derivatives.hessian), dual);
  return inertia.smallest > least_pivot && inertia.negative > kkt.equalities() ? Curvature::saddle : Curvature::open;
}

}  // namespace lagroid
