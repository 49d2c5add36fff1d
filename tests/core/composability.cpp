// Built with LAGROID_CHECKED: arrows that do not compose are caught, and gradients that are not those of L.
#include <lagroid/core/scalars/jet.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/product.hpp>
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace lagroid;

namespace {

TEST(CheckedBuild, RefusesArrowsThatDoNotCompose) {
  static_assert(checked_build);
  const Pair<2> groupoid;
  const PairArrow<double, 2> g{{0, 0}, {1, 0}};
  const PairArrow<double, 2> h{{1, 0.5}, {2, 2}};
  try {
    groupoid.compose(g, h);
    FAIL() << "composed";
  } catch (const NotComposable& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("Pair<2>"), std::string::npos) << message;
    EXPECT_NE(message.find("1 0.5"), std::string::npos) << message;
    EXPECT_NE(message.find("0.5 apart"), std::string::npos) << message;
  }
}

TEST(CheckedBuild, AllowsRoundOffAndEverythingOnGroups) {
  const Pair<1> groupoid;
  EXPECT_NO_THROW(groupoid.compose(PairArrow<double, 1>{Vector<double, 1>(0.0), Vector<double, 1>(1e6)},
                                   PairArrow<double, 1>{Vector<double, 1>(1e6 + 1e-9), Vector<double, 1>(3.0)}));
  const SO3 rotations;
  EXPECT_NO_THROW(rotations.compose(SO3::exp(Vector<double, 3>(1, 2, 3)), SO3::exp(Vector<double, 3>(0, 1, 0))));
}

TEST(CheckedBuild, SeesThroughDerivativesOfDerivatives) {
  using S = Jet<Jet<double, 1>, 1>;
  const Pair<1> groupoid;
  const auto arrow = [](double from, double to) { return PairArrow<S, 1>{Vector<S, 1>(S(from)), Vector<S, 1>(S(to))}; };
  EXPECT_NO_THROW(groupoid.compose(arrow(0, 1), arrow(1, 2)));
  EXPECT_THROW(groupoid.compose(arrow(0, 1), arrow(1.5, 2)), NotComposable);
}

TEST(CheckedBuild, LeavesWhatIsNoNumberToTheStatus) {
  const Pair<1> groupoid;
  const auto arrow = [](double from, double to) {
    return PairArrow<double, 1>{Vector<double, 1>(from), Vector<double, 1>(to)};
  };
  EXPECT_NO_THROW(groupoid.compose(arrow(0, std::nan("")), arrow(1, 2)));
  EXPECT_NO_THROW(groupoid.compose(arrow(0, HUGE_VAL), arrow(1, 2)));
}

TEST(CheckedBuild, SeesThroughProducts) {
  const Product<Pair<1>, SO3> groupoid;
  const auto r = SO3::exp(Vector<double, 3>(1, 2, 3));
  const ArrowOf<Product<Pair<1>, SO3>> g{PairArrow<double, 1>{Vector<double, 1>(0.0), Vector<double, 1>(1.0)}, r};
  EXPECT_THROW(groupoid.compose(g, g), NotComposable);
}

/// A particle; `Slip` is what its derivatives forget or double.
template <int Slip> struct Particle : System<Particle<Slip>, Pair<2>> {
  double h = 0.1;
  template <class S> S lagrangian(const PairArrow<S, 2>& g) const {
    return (g.target - g.source).squaredNorm() * (0.5 / h) - g.target.squaredNorm() * (0.5 * h);
  }
  // As a Lagrangian does that refers to numbers that are gone: with one scalar another function than with another.
  Gradients<2, 0> gradients(const PairArrow<double, 2>& g, const Vector<double, 0>& lambda) const {
    auto d = automatic_gradients(*this, g, lambda);
    d.target_gradient(1) += Slip * d.target_gradient(0);
    return d;
  }
};
template <int Slip> StepReport first_step() {
  const Particle<Slip> system;
  const State<Pair<2>> start{{1, 0}, {0.3, 0.4}};
  FixedStepIntegrator<Particle<Slip>> integrator(system, start, system.groupoid.unit(start.object),
                                                 std::make_unique<NewtonStep<Particle<Slip>>>());
  return integrator.advance();
}

TEST(CheckedBuild, RefusesGradientsThatAreNotThoseOfTheLagrangian) {
  EXPECT_TRUE(first_step<0>().converged());
  try {
    first_step<1>();
    FAIL() << "advanced";
  } catch (const WrongGradient& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("at the target"), std::string::npos) << message;
    EXPECT_NE(message.find("derivative_laws"), std::string::npos) << message;
  }
}

}  // namespace
