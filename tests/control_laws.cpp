// Control problems on groups, asked the laws of dynamics, momenta and symmetries.
#include <lagroid/solvers/testing/dynamics_laws.hpp>

#include "control_cases.hpp"

#include <gtest/gtest.h>

using namespace lagroid;

namespace {

template <class Sys> struct ControlLaws : testing::Test, Case<Sys> {
  ControlLaws() { this->system.h = 0.1; }
};
using Systems = testing::Types<Unicycle, AttitudeControl>;
TYPED_TEST_SUITE(ControlLaws, Systems);

TYPED_TEST(ControlLaws, DynamicsAndMomenta) {
  using G = typename TypeParam::GroupoidType;
  const auto draw = [] { return State<G>{{}, laws::draw_vector<3>(1.5)}; };
  for (const auto map : {Retraction::exponential, Retraction::cayley}) {
    this->system.map = map;
    const auto dynamics = laws::dynamics_laws(this->system, draw);
    EXPECT_TRUE(dynamics.holds()) << dynamics;
    const auto momenta = laws::momentum_laws(this->system, draw);
    EXPECT_TRUE(momenta.holds()) << momenta;
  }
}

TEST(AttitudeControlLaws, SymmetryAboutTheForbiddenAxis) {
  AttitudeControl system;
  system.h = 0.1;
  const auto draw = [] { return State<SO3>{{}, laws::draw_vector<3>(1.5)}; };
  const auto report = laws::noether_laws(system, system.symmetries(), draw);
  EXPECT_TRUE(report.holds()) << report;
  AttitudeControl uneven = system;
  uneven.weights(0) = 1.2;
  const auto broken = laws::noether_laws(uneven, system.symmetries(), draw);
  EXPECT_FALSE(broken.law("axial momentum M.n is a symmetry").holds()) << broken;
}

}  // namespace
