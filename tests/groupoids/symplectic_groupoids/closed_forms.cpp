// Local symplectic groupoids in closed form keep all laws.
#include "near_units.hpp"

#include <lagroid/systems/poisson/lotka_volterra.hpp>
#include <lagroid/systems/poisson/rotations.hpp>
#include <lagroid/systems/poisson/spins.hpp>

namespace lagroid::symplectic_groupoids_closed_forms_tests {
namespace {

TEST(SymplecticGroupoid, OfRotationsByTheExponential) {
  expect_all_laws(SymplecticGroupoid<RotationChart<EulerTop>>());
}

TEST(SymplecticGroupoid, OfRotationsByCayleysTransform) {
  expect_all_laws(SymplecticGroupoid<CayleyChart<EulerTop>>());
}

TEST(SymplecticGroupoid, OfSpins) { expect_all_laws(SymplecticGroupoid<CayleyChart<SpinChain<2>>>()); }

TEST(SymplecticGroupoid, OfPopulations) { expect_all_laws(SymplecticGroupoid<LogCanonicalChart<ThreeSpecies>>()); }

}  // namespace
}  // namespace lagroid::symplectic_groupoids_closed_forms_tests
