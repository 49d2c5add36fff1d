// Morphisms, reduction and reconstruction; maps that are no morphisms and systems that do not reduce are found out.
#include <lagroid/core/testing/algebroid_laws.hpp>
#include <lagroid/core/testing/morphism_laws.hpp>
#include <lagroid/groupoids/morphisms.hpp>
#include <lagroid/groupoids/rotated.hpp>
#include <lagroid/groupoids/trivial.hpp>
#include <lagroid/solvers/testing/reduction_laws.hpp>
#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include "../support/broken.hpp"
#include "../support/draws.hpp"

#include <gtest/gtest.h>

#include <concepts>

using namespace lagroid;

namespace core_morphisms_tests {
namespace {

Matrix<double, 3, 3> draw_attitude() { return SO3::exp(laws::draw_vector<3>(2.0)); }
laws::GroupoidLawOptions moderate() {
  laws::GroupoidLawOptions o;
  o.large = 1.5;
  return o;
}

TEST(PairOfAGroup, IsAGroupoidWithItsAlgebroid) {
  const auto axioms = laws::groupoid_laws(PairOf<SO3>{}, draw_attitude, moderate());
  EXPECT_TRUE(axioms.holds()) << axioms;
  const auto algebroid = laws::algebroid_laws(PairOf<SO3>{}, draw_attitude, moderate());
  EXPECT_TRUE(algebroid.holds()) << algebroid;
}

TEST(MorphismLaws, HoldForThoseOfTheLibrary) {
  const auto quotient = laws::morphism_laws(LeftQuotient<SO3>{}, draw_attitude, moderate());
  EXPECT_TRUE(quotient.holds()) << quotient;
  const auto difference = laws::morphism_laws<Difference<2>>();
  EXPECT_TRUE(difference.holds()) << difference;
  const auto acting = laws::morphism_laws<Acting<SO3, RotatedVectors>>({}, moderate());
  EXPECT_TRUE(acting.holds()) << acting;
  const auto projection = laws::morphism_laws<Projection<1, Pair<2>, SO3>>({}, moderate());
  EXPECT_TRUE(projection.holds()) << projection;
  const auto product = laws::morphism_laws<ProductMorphism<Difference<2>, IdentityMorphism<SO3>>>({}, moderate());
  EXPECT_TRUE(product.holds()) << product;
}

TEST(GaugeGroupoid, OfATrivialBundleIsTheTrivialOne) {
  using Phi = ProductMorphism<IdentityMorphism<Pair<2>>, LeftQuotient<SO3>>;
  static_assert(std::same_as<Phi::Codomain, Trivial<2, SO3>>);
  const auto point = [] { return std::tuple(laws::draw_vector<2>(1.0), draw_attitude()); };
  const auto report = laws::morphism_laws(Phi{}, point, moderate());
  EXPECT_TRUE(report.holds()) << report;
}

TEST(GaugeGroupoid, OfRotationsOverTheSphereIsTheirAction) {
  // The classes under rotations about e3 from the left are the fibres of (a, b) -> (a^{-1} b, e3 a).
  const StabiliserQuotient<SO3, RotatedDirections> phi(Vector<double, 3>::UnitZ());
  const ElementPair<Matrix<double, 3, 3>> g{SO3::exp(Vector<double, 3>(0.3, -1, 0.5)),
                                            SO3::exp(Vector<double, 3>(1, 0.2, -0.4))};
  const auto moved = [&](const Matrix<double, 3, 3>& k) {
    return ElementPair<Matrix<double, 3, 3>>{k * g.source, k * g.target};
  };
  const auto apart = [&](const auto& x, const auto& y) {
    return (phi.to.coordinates_of_arrow(x) - phi.to.coordinates_of_arrow(y)).norm();
  };
  const auto turned = moved(SO3::exp(Vector<double, 3>(0, 0, 0.7)));
  EXPECT_LT(apart(phi(turned), phi(g)), 1e-15);
  EXPECT_LT((phi.lift(turned.source, phi(g)).target - turned.target).norm(), 1e-15);
  EXPECT_GT(apart(phi(moved(SO3::exp(Vector<double, 3>(0.1, 0, 0.7)))), phi(g)), 0.01);
}

/// b a^{-1}, which reverses products, and a map that does not add lengths.
struct WrongQuotient : Morphism<WrongQuotient, PairOf<SO3>, SO3> {
  template <class E> E operator()(const ElementPair<E>& g) const {
    return this->to.multiply(g.target, this->to.inverse(g.source));
  }
};
struct Stretched : Morphism<Stretched, Pair<1>, VectorGroup<1>> {
  template <class S> Vector<S, 1> operator()(const PairArrow<S, 1>& g) const {
    const Vector<S, 1> d = g.target - g.source;
    return d * (d(0) * 0.01 + 1.0);
  }
};
/// Doubles the far end of every arrow, which leaves products and left-invariant fields related; halves none in the
/// lift.
struct Lopsided : Morphism<Lopsided, Pair<1>, Pair<1>> {
  template <class S> PairArrow<S, 1> operator()(const PairArrow<S, 1>& g) const { return {g.source, g.target * 2.0}; }
  template <class S> PairArrow<S, 1> lift(const Vector<S, 1>& q, const PairArrow<S, 1>& g) const {
    return {q, g.target};
  }
};
TEST(BrokenMorphism, IsFoundOut) {
  const auto wrong = laws::morphism_laws(WrongQuotient{}, draw_attitude, moderate());
  EXPECT_TRUE(laws::seen_broken(wrong.law("products"))) << wrong;
  EXPECT_TRUE(laws::seen_broken(wrong.law("left-invariant fields"))) << wrong;
  const auto stretched = laws::morphism_laws<Stretched>();
  EXPECT_TRUE(laws::seen_broken(stretched.law("products"))) << stretched;
  EXPECT_TRUE(laws::seen_broken(stretched.law("units and inverses"))) << stretched;
  const auto lopsided = laws::morphism_laws<Lopsided>();
  EXPECT_TRUE(lopsided.law("products").holds()) << lopsided;
  for (const auto* law : {"sources and targets", "anchors", "right-invariant fields", "lift"})
    EXPECT_TRUE(laws::seen_broken(lopsided.law(law))) << law << '\n' << lopsided;
}

RigidBody body() {
  RigidBody b;
  b.h = 0.05;
  return b;
}

TEST(Reduction, RigidBodyFromAttitudesToBodyMomenta) {
  const LeftQuotient<SO3> phi;
  const PulledBack<LeftQuotient<SO3>, RigidBody> full(body());
  const auto morphism = laws::system_morphism_laws(phi, full, body(), [&] {
    using Full = PulledBack<LeftQuotient<SO3>, RigidBody>;
    return Step<Full>{full.groupoid.tau(draw_attitude(), laws::draw_vector<3>(0.5)), {}};
  });
  EXPECT_TRUE(morphism.holds()) << morphism;
  const auto report =
      laws::reduction_laws(phi, full, body(), [] { return std::pair(draw_attitude(), laws::draw_vector<3>(1.5)); });
  EXPECT_TRUE(report.holds()) << report;
}

TEST(Reduction, RigidBodyOverTenThousandSteps) {
  const LeftQuotient<SO3> phi;
  const PulledBack<LeftQuotient<SO3>, RigidBody> full(body());
  const Vector<double, 3> momentum(1.2, 0.3, -0.5);
  const Matrix<double, 3, 3> attitude = SO3::exp(Vector<double, 3>(0.3, 0.1, 0.8));
  auto above = laws::detail::newton_integrator(full, phi.related(attitude, momentum));
  FixedStepIntegrator<RigidBody> below(body(), {{}, momentum}, attitude, std::make_unique<NewtonStep<RigidBody>>());
  for (int k = 0; k < 10'000; ++k) {
    ASSERT_TRUE(above.advance().converged());
    ASSERT_TRUE(below.advance().converged());
  }
  // The configuration of the reduced run is its reconstruction.
  EXPECT_LT((above.point().state.object - below.point().configuration).norm(), 1e-10);
  EXPECT_LT((above.point().state.momentum - below.point().state.momentum).norm(), 1e-10);
}

TEST(Reduction, RigidBodyFromTheActionGroupoid) {
  using Phi = Acting<SO3, RotatedVectors>;
  const PulledBack<Phi, RigidBody> full(body());
  const auto report = laws::reduction_laws(
      Phi{}, full, body(), [] { return std::pair(laws::draw_vector<3>(1.0), laws::draw_vector<3>(1.5)); });
  EXPECT_TRUE(report.holds()) << report;
}

/// The plate-ball system on the plate at rest, without the point of contact: on the group R^2 x SO(3), in the trace
/// form
/// ([G] (8)).
struct ReducedPlateBall : System<ReducedPlateBall, Product<VectorGroup<2>, SO3>, 3> {
  double h = 0.05;
  double radius = 1;
  double spin = 0;
  template <class S> S lagrangian(const Arrow<S>& g) const { return std::get<0>(g).squaredNorm() * (0.5 / h); }
  template <class S> Vector<S, 3> constraint(const Arrow<S>& g) const {
    const auto& [d, a] = g;
    const Vector<S, 3> w = SO3::vee(a);
    return {d(1) + w(0) * radius, d(0) - w(1) * radius, S(h * spin) - w(2)};
  }
};
using PlateMorphism = ProductMorphism<Difference<2>, IdentityMorphism<SO3>>;

TEST(Reduction, PlateBallByTranslations) {
  PlateBall full;
  full.h = 0.05;
  full.radius = 0.8;
  full.spin = 0.3;
  ReducedPlateBall reduced;
  reduced.radius = full.radius;
  reduced.spin = full.spin;
  const auto morphism =
      laws::system_morphism_laws(PlateMorphism{}, full, reduced, [&] { return draw_step(full, 0.3); });
  EXPECT_TRUE(morphism.holds()) << morphism;
  const auto report = laws::reduction_laws(PlateMorphism{}, full, reduced, [] {
    Vector<double, 5> mu;
    for (double& x : mu) x = laws::draw_uniform();
    return std::pair(std::tuple(laws::draw_vector<2>(2.0), Vector<double, 0>()), mu);
  });
  EXPECT_TRUE(report.holds()) << report;
  // On the turning plate translations are no symmetry.
  full.plate_rate = 0.4;
  const auto turning = laws::system_morphism_laws(PlateMorphism{}, full, reduced, [&] { return draw_step(full, 0.3); });
  EXPECT_TRUE(laws::seen_broken(turning.law("Lagrangians and constraints"))) << turning;
  EXPECT_TRUE(laws::seen_broken(turning.law("Legendre transforms are related"))) << turning;
}

TEST(Reduction, OfAnotherBodyIsFoundOut) {
  RigidBody other = body();
  other.inertia(0) = 1.001;
  const PulledBack<LeftQuotient<SO3>, RigidBody> full(body());
  const auto report = laws::reduction_laws(LeftQuotient<SO3>{}, full, other,
                                           [] { return std::pair(draw_attitude(), Vector<double, 3>(1, 0.5, -1)); });
  EXPECT_TRUE(laws::seen_broken(report.law("images of arrows"))) << report;
  EXPECT_TRUE(laws::seen_broken(report.law("related momenta"))) << report;
  EXPECT_TRUE(laws::seen_broken(report.law("reconstruction"))) << report;
}

}  // namespace
}  // namespace core_morphisms_tests
