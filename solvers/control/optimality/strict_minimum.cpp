#include <lagroid/solvers/control/optimality/strict_minimum.hpp>

#include <algorithm>
#include <cstddef>

namespace lagroid {

bool is_strict_minimum(StageKkt& kkt, const StageDerivatives& derivatives, const StageRows& multipliers,
                       const StageRows& slacks, StageRows& sigma, StageRows& dual) {
  constexpr double least_pivot = 1e-18;
  constexpr double idle = 1e-6;    // sigma of what is nowhere near to acting
  constexpr double least = 1e-11;  // a pivot that is smaller would leave no digits of those after it
  for (std::size_t i = 0; i < sigma.numbers().size(); ++i) {
    const double of_it = multipliers.numbers()[i] / slacks.numbers()[i];
    sigma.numbers()[i] = of_it < idle ? -std::max(of_it, least) : of_it;
  }
  kkt.assemble(derivatives, sigma);
  set_all(dual, 0);
  const StageKkt::Inertia inertia = kkt.factor(0, dual);
  return inertia.smallest > least_pivot && inertia.negative == kkt.equalities();
}

}  // namespace lagroid
