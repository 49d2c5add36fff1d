// The library's own suites on discretised Lagrangians.
#include <lagroid/solvers/galerkin/galerkin.hpp>
#include <lagroid/solvers/galerkin/rules_of_order_two.hpp>
#include <lagroid/solvers/testing/certificate.hpp>

#include "subjects.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace {

template <class Sys, class Draw> void expect_laws(const Sys& system, const Draw& draw) {
  for (const laws::LawReport& report : laws::system_laws<Sys>(system, draw)) EXPECT_TRUE(report.holds()) << report;
}

State<Pair<2>> draw_orbit() {
  return {{1 + 0.2 * laws::draw_uniform(), 0.1 * laws::draw_uniform()},
          {0.2 * laws::draw_uniform(), 1 + 0.2 * laws::draw_uniform()}};
}
State<Top::GroupoidType> draw_top() {
  const double tilt = laws::draw_uniform();
  return {{std::sin(tilt), 0, std::cos(tilt)}, {0.3 * laws::draw_uniform(), 0.4, 1 + 0.3 * laws::draw_uniform()}};
}

// Derivatives through the inner solve, Poisson steps, Noether: as of a system that was written by hand.
TEST(AnyLagrangian, LawsOfAnOrbit) { expect_laws(Galerkin<Orbit, 3>{Orbit{}, 0.1}, draw_orbit); }
TEST(AnyLagrangian, LawsOfATop) { expect_laws(Galerkin<Top, 2>{Top{}, 0.1}, draw_top); }
TEST(AnyLagrangian, LawsOfAConstrainedMotion) {
  expect_laws(Midpoint<Area>{Area{}, 0.1}, [] {
    return State<Pair<3>>{{0.5 * laws::draw_uniform(), 0.3, 0.1}, {0.5, laws::draw_uniform(), 1}};
  });
}

}  // namespace
