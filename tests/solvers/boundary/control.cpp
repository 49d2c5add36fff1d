// Optimal control on groups: the unicycle and the body with a forbidden axis, against their continuous extremals and
// the discrete Lie-Poisson equations.
#include <lagroid/solvers/boundary/boundary_values.hpp>

#include "control_cases.hpp"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

using namespace lagroid;

namespace boundary_control_tests {
namespace {

void expect_order_two(const std::vector<double>& errors) {
  for (std::size_t i = 0; i + 1 < errors.size(); ++i) EXPECT_NEAR(std::log2(errors[i] / errors[i + 1]), 2, 0.05);
}

template <class Sys> struct Extremals : testing::Test, Case<Sys> {};
using Systems = testing::Types<Unicycle, AttitudeControl>;
TYPED_TEST_SUITE(Extremals, Systems);

TYPED_TEST(Extremals, OfTheContinuousProblemKeepTheIntegrals) {
  using G = typename TypeParam::GroupoidType;
  Matrix3 at = Matrix3::Identity();
  const auto end = this->system.reference({{}, this->momentum}, at, 7.0);
  EXPECT_GT((end.momentum - this->momentum).norm(), 0.1);
  EXPECT_NEAR(this->system.energy(end), this->system.energy({{}, this->momentum}), 1e-11);
  EXPECT_NEAR(this->casimir(end.momentum), this->casimir(this->momentum), 1e-12);
  EXPECT_LT((G::adjoint(G::inverse(at)).transpose() * end.momentum - this->momentum).norm(), 1e-11);
}

TYPED_TEST(Extremals, OrderTwoInMomentumAndConfiguration) {
  for (const auto map : {Retraction::exponential, Retraction::cayley}) {
    this->system.map = map;
    Matrix3 at = Matrix3::Identity();
    const auto exact = this->system.reference({{}, this->momentum}, at, 3.0);
    std::vector<double> errors;
    for (const int steps : {100, 200, 400}) {
      this->system.h = 3.0 / steps;
      auto integrator = walk(this->system, this->momentum);
      for (int k = 0; k < steps; ++k) ASSERT_TRUE(integrator.advance().converged());
      errors.push_back((integrator.point().state.momentum - exact.momentum).norm() +
                       (integrator.point().configuration - at).norm());
    }
    expect_order_two(errors);
  }
}

TYPED_TEST(Extremals, KeepTheSpatialMomentumAndTheCasimir) {
  for (const auto map : {Retraction::exponential, Retraction::cayley}) {
    this->system.map = map;
    this->system.h = 0.02;
    auto integrator = walk(this->system, this->momentum);
    const auto spatial = this->system.quantities().at(1);
    double size = 0;
    double drift = 0;
    double casimir_drift = 0;
    for (int k = 0; k < 10'000; ++k) {
      ASSERT_TRUE(integrator.advance().converged());
      const auto& point = integrator.point();
      Vector3 now;
      spatial.evaluate(point, now.data());
      size = std::max(size, spatial.size(point));
      drift = std::max(drift, (now - this->momentum).norm());
      casimir_drift =
          std::max(casimir_drift, std::abs(this->casimir(point.state.momentum) / this->casimir(this->momentum) - 1));
    }
    EXPECT_LT(drift, 1e-13 * size);
    EXPECT_LT(casimir_drift, 1e-13);
  }
}

TYPED_TEST(Extremals, EnergyStaysInABandThatShrinksWithTheStep) {
  std::vector<double> band;
  for (const double h : {0.04, 0.02}) {
    this->system.h = h;
    auto integrator = walk(this->system, this->momentum);
    double& largest = band.emplace_back(0);
    const double energy = this->system.energy({{}, this->momentum});
    for (int k = 0; k * h < 200; ++k) {
      ASSERT_TRUE(integrator.advance().converged());
      largest = std::max(largest, std::abs(this->system.energy(integrator.point().state) - energy));
    }
  }
  EXPECT_NEAR(std::log2(band[0] / band[1]), 2, 0.1);
}

/// The smallest mean square of <F+ - F-, X> over unit X, along 20 steps. A section of the algebroid of a group is a
/// constant X, and a symmetry where this is zero.
template <class Sys> double least_change(const Sys& system, const Vector3& momentum) {
  Matrix3 squares = Matrix3::Zero();
  for (const auto& step : steps_of(system, momentum, 20)) {
    const Vector3 change = legendre_plus(system, step).momentum - legendre_minus(system, step).momentum;
    squares += change * change.transpose() / 20;
  }
  return Eigen::SelfAdjointEigenSolver<Matrix3>(squares).eigenvalues()(0);
}

TYPED_TEST(Extremals, HaveNoSymmetryInGeneral) {
  this->system.h = 0.1;
  EXPECT_GT(least_change(this->system, this->momentum), 1e-7);
}

TEST(AttitudeControl, IsSymmetricAboutTheForbiddenAxisWhereItsWeightsAre) {
  const Vector3 momentum(0.9, -0.4, 1.1);
  const auto system = [](const Vector3& weights, const Vector3& forbidden) {
    AttitudeControl out;
    out.h = 0.1;
    out.weights = weights;
    out.forbidden = forbidden.normalized();
    return out;
  };
  for (const auto& axial :
       {system({2, 2, 0.7}, {0, 0, 1}), system({1, 2, 1.5}, {1, 1, 0}), system({1, 1, 1}, {3, -2, 5})}) {
    ASSERT_EQ(axial.symmetries().size(), 1U);
    EXPECT_LT(least_change(axial, momentum), 1e-16);
    const auto steps = steps_of(axial, momentum, 20);
    EXPECT_EQ(examine<AttitudeControl>(axial, axial.symmetries()[0], steps).kind, SymmetryKind::symmetric);
  }
  for (const auto& other : {system({2, 2.1, 0.7}, {0, 0, 1}), system({1, 1, 1.1}, {3, 4, 0})}) {
    EXPECT_TRUE(other.symmetries().empty());
    const Symmetry<AttitudeControl> about{"M.n", [n = other.forbidden](const auto&) { return n; }};
    const auto steps = steps_of(other, momentum, 20);
    EXPECT_EQ(examine<AttitudeControl>(other, about, steps).kind, SymmetryKind::none);
  }
}

TEST(AttitudeControl, ReferenceIsTheSubRiemannianGeodesic) {
  // Weights 1.5 in every direction across n.
  AttitudeControl system;
  system.weights << 1, 2, 1.5;
  system.forbidden = Vector3(1, 1, 0).normalized();
  const Vector3 n = system.forbidden;
  const Vector3 a = n.cross(Vector3(0.3, 1.1, -0.8));
  const double b = 1.7;
  const State<SO3> start{{}, 1.5 * (a + b * n)};
  Matrix3 at = Matrix3::Identity();
  system.reference(start, at, 2.0);
  EXPECT_LT((at - SO3::exp(Vector3(2 * (a + b * n))) * SO3::exp(Vector3(-2 * b * n))).norm(), 1e-12);
  EXPECT_NEAR(system.energy(start), 1.5 * a.squaredNorm() / 2, 1e-14);
}

TYPED_TEST(Extremals, AreThoseOfTheLiePoissonEquations) {
  for (const auto map : {Retraction::exponential, Retraction::cayley}) {
    this->system.h = 0.05;
    this->system.map = map;
    EXPECT_LT(lie_poisson_difference(this->system, this->system, this->momentum), 1e-12);
    auto other = this->system;
    other.map = map == Retraction::cayley ? Retraction::exponential : Retraction::cayley;
    EXPECT_GT(lie_poisson_difference(this->system, other, this->momentum), 1e-6);
  }
}

/// The cheapest path to `end` in `steps` steps of h.
template <class Sys> BoundarySolution<Sys> cheapest(Sys system, const Matrix3& end, double duration, int steps) {
  system.h = duration / steps;
  MultistartOptions options;
  options.starts = 10;
  const auto found =
      solve_boundary(*make_boundary_solver<Sys>(), BoundaryProblem<Sys>{system, end}, std::size_t(steps), options);
  EXPECT_FALSE(found.solutions.empty());
  return found.solutions.empty() ? BoundarySolution<Sys>{} : found.solutions.front();
}

TEST(Elastica, BetweenTwoPosesIsFound) {
  for (const auto map : {Retraction::exponential, Retraction::cayley}) {
    Unicycle system;
    system.map = map;
    const Vector3 momentum(0.8, -1.0, 1.5);
    Matrix3 end = Matrix3::Identity();
    system.reference({{}, momentum}, end, 2.0);
    std::vector<double> errors;
    for (const int steps : {40, 80, 160}) {
      const auto found = cheapest(system, end, 2.0, steps);
      ASSERT_TRUE(found.converged());
      EXPECT_TRUE(found.kind.is_minimum && found.kind.isolated && found.kind.normal);
      system.h = 2.0 / steps;
      errors.push_back((initial_momentum(system, found.path) - momentum).norm());
    }
    EXPECT_LT(errors.back(), 1e-3);
    expect_order_two(errors);
  }
}

TEST(AttitudeControl, CostsWhatTheGeodesicDoes) {
  for (const auto map : {Retraction::exponential, Retraction::cayley}) {
    AttitudeControl system;
    system.map = map;
    const Vector3 a(1.2, -0.7, 0);
    const Vector3 b(0, 0, 1.5);
    const Matrix3 end = SO3::exp(Vector3(a + b)) * SO3::exp(Vector3(-b));
    std::vector<double> costs;
    std::vector<double> momenta;
    for (const int steps : {40, 80, 160}) {
      const auto found = cheapest(system, end, 1.0, steps);
      ASSERT_TRUE(found.converged());
      EXPECT_TRUE(found.kind.is_minimum && found.kind.isolated && found.kind.normal);
      system.h = 1.0 / steps;
      costs.push_back(std::abs(found.cost - a.squaredNorm() / 2));
      momenta.push_back((initial_momentum(system, found.path) - a - b).norm());
    }
    expect_order_two(costs);
    expect_order_two(momenta);
  }
}

TEST(AttitudeControl, TurnsAboutTheForbiddenAxis) {
  // exp(a + b n) exp(-b n) = exp(angle n) where |a + b n| = 2 pi and b = 2 pi - angle, so |a|^2 = angle (4 pi - angle);
  // a may point anywhere across n.
  constexpr double angle = 2;
  const AttitudeControl system;
  std::vector<double> errors;
  for (const int steps : {40, 80, 160}) {
    const auto found = cheapest(system, SO3::exp(Vector3(0, 0, angle)), 1.0, steps);
    ASSERT_TRUE(found.converged());
    EXPECT_TRUE(found.kind.is_minimum);
    EXPECT_FALSE(found.kind.isolated);
    errors.push_back(std::abs(found.cost - angle * (4 * std::numbers::pi - angle) / 2));
  }
  expect_order_two(errors);
  AttitudeControl uneven;
  uneven.weights << 1, 1.3, 1;
  EXPECT_TRUE(cheapest(uneven, SO3::exp(Vector3(0, 0, angle)), 1.0, 40).kind.isolated);
}

}  // namespace
}  // namespace boundary_control_tests
