// Brackets of Poisson systems: antisymmetry, the Jacobi identity, Casimirs, and subjects that fail each.
#include "../../support/broken.hpp"

#include <lagroid/core/testing/poisson_laws.hpp>
#include <lagroid/systems/poisson/fields.hpp>
#include <lagroid/systems/poisson/lattices.hpp>
#include <lagroid/systems/poisson/lotka_volterra.hpp>
#include <lagroid/systems/poisson/rotations.hpp>
#include <lagroid/systems/poisson/spins.hpp>
#include <lagroid/systems/poisson/tops.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <string>

namespace lagroid::poisson_poisson_brackets_tests {
namespace {

/// Between 0.4 and 1.6: where logarithms are smooth too.
template <class Sys> Vector<double, Sys::dimension> draw() {
  Vector<double, Sys::dimension> x;
  for (int i = 0; i < x.size(); ++i) x(i) = 1 + 0.6 * laws::draw_uniform();
  return x;
}
template <class Sys> laws::LawReport report(const char* name, const Sys& system = {}) {
  return laws::poisson_laws(name, system, draw<Sys>);
}

TEST(PoissonBrackets, ThoseOfTheSystemsAreThat) {
  for (const laws::LawReport& each :
       {report<LotkaVolterra>("predator and prey"), report<ThreeSpecies>("three species"),
        report<VolterraRing<5>>("Volterra ring"), report<EulerTop>("Euler top"), report<Kirchhoff>("Kirchhoff"),
        report("body on a sphere",
               [] {
                 Kirchhoff body;
                 body.kappa = 1;
                 return body;
               }()),
        report<OpenToda<3>>("Toda row of 3"), report<OpenToda<4>>("Toda row of 4"),
        report<PeriodicToda<3>>("Toda ring"), report<MaxwellBloch>("Maxwell-Bloch"), report<Sklyanin>("Sklyanin"),
        report<MagneticParticle>("magnetic"), report<HeavyTopBracket>("heavy top"),
        report<BodyInSpace>("body in space"), report<SpinChain<3>>("spins")})
    EXPECT_TRUE(each.holds()) << each;
}

/// pi = F x of a field F with F.curl F != 0: moves points like any other, and is no Poisson bracket.
struct Curled : PoissonSystem<Curled, 3> {
  template <class S> Matrix<S, 3, 3> bivector(const Vector<S, 3>& x) const {
    return skew<S, 3>({{0, 1, -x(0)}, {0, 2, x(2)}, {1, 2, -x(1)}});
  }
  template <class S> Vector<S, 1> casimirs(const Vector<S, 3>& x) const { return Vector<S, 1>(x(0)); }
};

/// One entry of the wrong sign below the diagonal.
struct Lopsided : PoissonSystem<Lopsided, 2> {
  template <class S> Matrix<S, 2, 2> bivector(const Vector<S, 2>& x) const {
    Matrix<S, 2, 2> pi = skew<S, 2>({{0, 1, x(0)}});
    pi(1, 0) = x(0);
    return pi;
  }
};

TEST(PoissonBrackets, OneThatFailsTheJacobiIdentityIsNamedWithItsWorstPoint) {
  const laws::LawReport found = report<Curled>("curled");
  EXPECT_TRUE(found.law("the bivector is antisymmetric").holds()) << found;
  const laws::Law& jacobi = found.law("Jacobi identity of the bracket");
  EXPECT_TRUE(laws::seen_broken(jacobi)) << found;
  EXPECT_EQ(jacobi.first_failure.rfind("Jacobi identity of (1, 2, 3) is -", 0), 0U) << jacobi.first_failure;
  EXPECT_TRUE(laws::seen_broken(found.law("Casimirs commute with all functions"))) << found;
}

TEST(PoissonBrackets, OneThatIsNotAntisymmetricIsSeen) {
  const laws::LawReport found = report<Lopsided>("lopsided");
  EXPECT_TRUE(laws::seen_broken(found.law("the bivector is antisymmetric"))) << found;
}

TEST(PoissonBrackets, TheRecordedBracketThatIsNoneIsRefusedWithTheRecordedValue) {
  const auto cases = nlohmann::json::parse(std::ifstream(std::string(LAGROID_TEST_DATA) + "/poisson.json"))["cases"];
  bool seen = false;
  for (const auto& c : cases) {
    if (c["id"] != "B-not-poisson") continue;
    seen = true;
    Vector<double, 3> x;
    for (int i = 0; i < 3; ++i) x(i) = std::stod(c["initial"][std::size_t(i)].get<std::string>());
    const BracketDefect worst = worst_bracket_defect(Curled{}, x);
    EXPECT_NEAR(jacobi_defect(Curled{}, x).value, std::stod(c["results"]["jacobiator_at_point"].get<std::string>()),
                1e-15);
    EXPECT_GT(worst.relative, 0.09);
    EXPECT_NE(worst.sentence().find("at (0.3, 0.5, -0.7), not 0"), std::string::npos) << worst.sentence();
  }
  EXPECT_TRUE(seen);
}

TEST(PoissonBrackets, SumsOfPartsHaveTheDerivativesOfTheirFormula) {
  // x' and y' of predator and prey, written out.
  const LotkaVolterra system;
  const Vector<double, 2> x(2, 0.5);
  const Vector<double, 2> rate = system.velocity(x);
  EXPECT_NEAR(rate(0), x(0) - x(0) * x(1), 1e-15);
  EXPECT_NEAR(rate(1), x(0) * x(1) - x(1), 1e-15);
  const auto energy = energy_derivatives(system, x);
  EXPECT_NEAR((energy.gradient - system.gradient(x)).norm(), 0, 1e-15);
  EXPECT_NEAR(energy.hessian(0, 0), -1 / (x(0) * x(0)), 1e-15);
  EXPECT_EQ(casimir_count<LotkaVolterra>(), 0);
  EXPECT_EQ(casimir_count<Kirchhoff>(), 2);
}

}  // namespace
}  // namespace lagroid::poisson_poisson_brackets_tests
