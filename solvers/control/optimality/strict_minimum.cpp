#include "strict_minimum.hpp"

#include <cstddef>

namespace lagroid {

bool is_strict_minimum(StageKkt& kkt, const StageDerivatives& derivatives, const StageRows& multipliers,
                       const StageRows& slacks, StageRows& sigma, StageRows& dual) {
  constexpr double least_pivot = 1e-18;
  constexpr double relaxed = 1e-11;  // of equalities that depend on each other
  for (std::size_t i = 0; i < sigma.numbers().size(); ++i) {
    const double z = multipliers.numbers()[i];
    const double s = slacks.numbers()[i];
    sigma.numbers()[i] = z > s ? z / s : -z / s;
  }
  kkt.assemble(derivatives, sigma);
  for (const double shift : {0.0, relaxed}) {
    set_all(dual, shift);
    const StageKkt::Inertia inertia = kkt.factor(0, dual);
    if (inertia.smallest > least_pivot) return inertia.negative == kkt.equalities();
  }
  return false;
}

}  // namespace lagroid
