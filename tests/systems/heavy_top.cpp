// The heavy top on the action groupoid, against the continuous one, its integrable cases, and itself unreduced.
#include "../support/broken.hpp"
#include "../support/run_watch.hpp"

#include <lagroid/core/testing/derivative_laws.hpp>
#include <lagroid/core/testing/morphism_laws.hpp>
#include <lagroid/groupoids/morphisms.hpp>
#include <lagroid/solvers/testing/dynamics_laws.hpp>
#include <lagroid/solvers/testing/reduction_laws.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

using namespace lagroid;

namespace systems_heavy_top_tests {
namespace {

using G = HeavyTop::GroupoidType;

HeavyTop asymmetric() {
  HeavyTop top;
  top.inertia << 1.1, 0.8, 0.5;
  top.weight << 0.3, -0.2, 0.9;
  return top;
}
HeavyTop kovalevskaya() {
  HeavyTop top;
  top.inertia << 2, 2, 1;
  top.weight << 0.8, 0.6, 0;
  return top;
}
Vector<double, 3> draw_direction() {
  return (laws::draw_vector<3>(1.0) + Vector<double, 3>(0.01, -0.02, 0.03)).normalized();
}
State<G> draw_state() { return {draw_direction(), laws::draw_vector<3>(1.5)}; }
const State<G> leaning{Vector<double, 3>(0.48, 0.6, 0.64), Vector<double, 3>(0.3, -0.2, 1.5)};

TEST(HeavyTop, Derivatives) {
  for (const auto map : {RotationMap::exponential, RotationMap::cayley}) {
    HeavyTop top = asymmetric();
    top.rotation = map;
    const auto report = laws::derivative_laws(top, [&] {
      return Step<HeavyTop>{top.groupoid.tau(draw_direction(), Vector<double, 3>(laws::draw_vector<3>(0.4))), {}};
    });
    EXPECT_TRUE(report.holds()) << report;
  }
}

TEST(HeavyTop, OfLagrangeIsSymmetricAboutItsAxisToo) {
  HeavyTop top;
  top.h = 0.1;
  ASSERT_TRUE(top.is_lagrange());
  EXPECT_EQ(top.symmetries().size(), 2U);
  const auto report = laws::noether_laws(top, top.symmetries(), draw_state);
  EXPECT_TRUE(report.holds()) << report;
  // The axial symmetry is none of a top that leans.
  const auto false_one = laws::noether_laws(asymmetric(), {top.symmetries()[1]}, draw_state);
  EXPECT_TRUE(laws::seen_broken(false_one.law("axial momentum M3 is a symmetry"))) << false_one;
}

TEST(HeavyTop, OrderTwoInStateAndAttitude) {
  for (const auto map : {RotationMap::exponential, RotationMap::cayley}) {
    HeavyTop top = asymmetric();
    top.rotation = map;
    const Matrix<double, 3, 3> start =
        Eigen::Quaterniond::FromTwoVectors(leaning.object, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    Matrix<double, 3, 3> attitude = start;
    const auto exact = top.reference(leaning, attitude, 2.0);
    std::vector<double> errors;
    for (const int steps : {100, 200, 400}) {
      top.h = 2.0 / steps;
      FixedStepIntegrator<HeavyTop> integrator(top, leaning, {start, Vector<double, 3>::UnitZ()},
                                               std::make_unique<NewtonStep<HeavyTop>>());
      for (int k = 0; k < steps; ++k) ASSERT_TRUE(integrator.advance().converged());
      const auto& end = integrator.point();
      errors.push_back((end.state.object - exact.object).norm() + (end.state.momentum - exact.momentum).norm() +
                       (end.configuration.element - attitude).norm());
    }
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2, 0.05);
    EXPECT_NEAR(std::log2(errors[1] / errors[2]), 2, 0.05);
  }
}

TEST(HeavyTop, ReferenceKeepsTheIntegrals) {
  for (const auto& top : {asymmetric(), kovalevskaya(), HeavyTop{}}) {
    Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
    const auto end = top.reference(leaning, attitude, 5.0);
    EXPECT_NEAR(top.energy(end), top.energy(leaning), 1e-11);
    for (const auto& symmetry : top.symmetries())
      EXPECT_NEAR(symmetry.momentum(end), symmetry.momentum(leaning), 1e-11) << symmetry.name;
    if (!top.is_kovalevskaya()) continue;
    EXPECT_NEAR(top.kovalevskaya_integral(end), top.kovalevskaya_integral(leaning), 1e-10);
  }
  EXPECT_FALSE(asymmetric().is_kovalevskaya());
}

TEST(HeavyTop, KovalevskayasIntegralStaysInABandThatShrinksWithTheStep) {
  std::vector<double> band;
  for (const double h : {0.02, 0.01}) {
    HeavyTop top = kovalevskaya();
    top.h = h;
    const auto seen = watch(top, leaning, long(200 / h));
    ASSERT_FALSE(seen.empty());
    band.push_back(seen.at("Kovalevskaya integral").drift);
    EXPECT_LT(seen.at("energy").last_quarter, 1.5 * seen.at("energy").first_quarter);
    EXPECT_LT(seen.at("vertical momentum M.v").drift, 1e-12);
  }
  EXPECT_NEAR(std::log2(band[0] / band[1]), 2, 0.3);
}

TEST(HeavyTop, OfLagrangeOverAMillionSteps) {
  HeavyTop top;
  top.h = 0.02;
  constexpr long steps = 1'000'000;
  using Point = TrajectoryPoint<HeavyTop>;
  const auto seen =
      watch(top, leaning, steps,
            {{"length of the vertical", {"|v|"}, Promise::conserved, false, [](const Point& p, double* out) {
                *out = p.state.object.norm();
              }}});
  ASSERT_FALSE(seen.empty());
  // No more than a random walk of round-off: one unit in the last place a step would be fifty times as much.
  const double walk = 20 * std::numeric_limits<double>::epsilon() * std::sqrt(double(steps));
  for (const auto* name : {"vertical momentum M.v", "axial momentum M3", "length of the vertical"})
    EXPECT_LT(seen.at(name).drift, walk) << name;
  const auto& energy = seen.at("energy");
  EXPECT_LT(energy.last_quarter, 1.05 * energy.first_quarter);
  EXPECT_LT(energy.trend, 1e-3 * energy.drift);
}

TEST(HeavyTop, ReducesFromAttitudes) {
  // The same top on Pair(SO(3)), where its objects are attitudes; gravity breaks all symmetry but the vertical.
  using Phi = StabiliserQuotient<SO3, RotatedDirections>;
  const Phi phi(Vector<double, 3>::UnitZ());
  const auto attitude = [] { return Matrix<double, 3, 3>(SO3::exp(laws::draw_vector<3>(1.5))); };
  laws::GroupoidLawOptions moderate;
  moderate.large = 1.5;
  const auto morphism = laws::morphism_laws(phi, attitude, moderate);
  EXPECT_TRUE(morphism.holds()) << morphism;
  HeavyTop top = asymmetric();
  top.h = 0.05;
  const PulledBack<Phi, HeavyTop> full(top, phi);
  const auto report =
      laws::reduction_laws(phi, full, top, [&] { return std::pair(attitude(), laws::draw_vector<3>(1.5)); });
  EXPECT_TRUE(report.holds()) << report;
}

TEST(HeavyTop, IsReconstructedOverTenThousandSteps) {
  // Lagrange's top: its motion is regular, so that round-off grows with the time and no faster.
  using Phi = StabiliserQuotient<SO3, RotatedDirections>;
  const Phi phi(Vector<double, 3>::UnitZ());
  HeavyTop top;
  top.h = 0.02;
  const PulledBack<Phi, HeavyTop> full(top, phi);
  const Matrix<double, 3, 3> attitude =
      Eigen::Quaterniond::FromTwoVectors(leaning.object, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  auto above = laws::detail::newton_integrator(full, phi.related(attitude, leaning.momentum));
  FixedStepIntegrator<HeavyTop> below(top, {phi.object(attitude), leaning.momentum}, {attitude, phi.fixed},
                                      std::make_unique<NewtonStep<HeavyTop>>());
  for (int k = 0; k < 10'000; ++k) {
    ASSERT_TRUE(above.advance().converged());
    ASSERT_TRUE(below.advance().converged());
  }
  const auto& end = above.point().state;
  EXPECT_LT((end.object - below.point().configuration.element).norm(), 1e-10);
  EXPECT_LT((phi.object(end.object) - below.point().state.object).norm(), 1e-10);
  EXPECT_LT((end.momentum - below.point().state.momentum).norm(), 1e-10);
}

}  // namespace
}  // namespace systems_heavy_top_tests
