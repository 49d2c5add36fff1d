// Local symplectic groupoids by flows with frozen momenta keep all laws.
#include "near_units.hpp"

#include <lagroid/core/testing/sampling.hpp>
#include <lagroid/systems/poisson/lotka_volterra.hpp>

namespace lagroid::symplectic_groupoids_frozen_flows_tests {
namespace {

TEST(SymplecticGroupoid, ByFrozenFlowsToRoundOff) {
  const laws::Sampling few(3, 3);
  expect_all_laws(SymplecticGroupoid<FrozenChart<LotkaVolterra>>());
}

}  // namespace
}  // namespace lagroid::symplectic_groupoids_frozen_flows_tests
