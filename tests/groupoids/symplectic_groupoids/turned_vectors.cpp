// Symplectic groupoids of rotations that turn vectors keep all laws.
#include "near_units.hpp"

#include <lagroid/systems/poisson/tops.hpp>

namespace lagroid::symplectic_groupoids_turned_vectors_tests {
namespace {

TEST(SymplecticGroupoid, OfRotationsThatTurnAVector) {
  expect_all_laws(SymplecticGroupoid<SemidirectChart<HeavyTopBracket, RotationArcs>>());
  expect_all_laws(SymplecticGroupoid<SemidirectChart<HeavyTopBracket, CayleyArcs>>());
}

TEST(SymplecticGroupoid, OfRotationsThatTurnThreeVectors) {
  expect_all_laws(SymplecticGroupoid<SemidirectChart<BodyInSpace, CayleyArcs>>());
}

}  // namespace
}  // namespace lagroid::symplectic_groupoids_turned_vectors_tests
