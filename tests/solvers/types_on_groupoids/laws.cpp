// The library's own suites on Hamiltonian Taylor integrators.
#include "../continuous_lagrangian/laws.hpp"
#include "subjects.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace types_on_groupoids_laws_tests {
namespace {

TEST(TypesOnGroupoids, LawsOfAHamiltonianThatIsNotSeparable) {
  expect_laws(HamiltonianTaylor<Coupled, 1>{{}, 0.1}, [] {
    return State<Pair<2>>{{0.3 * laws::draw_uniform(), 0.3}, {0.4, 0.5 * laws::draw_uniform()}};
  });
}
TEST(TypesOnGroupoids, LawsOfABody) {
  expect_laws(HamiltonianTaylor<FreeBodyByMomentum<SO3>, 1, GeneratingType::three>{{}, 0.1}, [] {
    return State<SO3>{{}, {0.4 * laws::draw_uniform(), 0.2, 1 + 0.5 * laws::draw_uniform()}};
  });
}

}  // namespace
}  // namespace types_on_groupoids_laws_tests
