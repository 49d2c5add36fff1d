// The chain of pendulums: energy, accelerations, frequencies, what is refused.
#include "chains.hpp"

#include <lagroid/core/testing/property.hpp>
#include <lagroid/solvers/lie_group/integrator.hpp>
#include <lagroid/systems/pendulums/chain_rattle.hpp>
#include <lagroid/systems/pendulums/pendulum_chain.hpp>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <cmath>
#include <stdexcept>
#include <string>

namespace lagroid::pendulum_chain_tests::equations_tests {
namespace {

/// F(z).
template <class F> Points value(F field, const Points& z) {
  Points u = z;
  field(0, z, u);
  return u;
}

TEST(PendulumChain, EnergyMomentaAndLegendreTransformAreTheRecorded) {
  for (const auto& c : cases()) {
    EXPECT_NEAR(c.chain.energy(c.velocities), c.energy, 1e-14 * (1 + std::abs(c.energy))) << c.name;
    EXPECT_NEAR(c.chain.vertical_momentum(c.velocities), c.vertical, 1e-14 * (1 + std::abs(c.vertical))) << c.name;
    EXPECT_LT(largest(c.chain.to_momenta(c.velocities) - c.momenta), 1e-15) << c.name;
    EXPECT_LT(largest(c.chain.to_velocities(c.momenta) - c.velocities), 1e-13) << c.name;
  }
}

/// The matrix and right side of dense equations of motion, by Lagrange's multipliers: M q'' = -grad U + 2 lambda_i q_i.
Points dense_accelerations(const Chain& chain, const Points& z) {
  const int k = chain.links();
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(4 * k, 4 * k);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(4 * k);
  for (int i = 0; i < k; ++i) {
    for (int j = 0; j < k; ++j)
      a.block<3, 3>(3 * i, 3 * j) =
          Eigen::Matrix3d::Identity() * (chain.carried(std::max(i, j)) * chain.length(i) * chain.length(j));
    a.block<3, 1>(3 * i, 3 * k + i) = z.col(i).head<3>();
    a.block<1, 3>(3 * k + i, 3 * i) = z.col(i).head<3>().transpose();
    b(3 * i + 2) = -chain.gravity * chain.carried(i) * chain.length(i);
    b(3 * k + i) = -z.col(i).tail<3>().squaredNorm();
  }
  const Eigen::VectorXd x = a.fullPivLu().solve(b);
  Points out = z;
  for (int i = 0; i < k; ++i) {
    const V q = z.col(i).head<3>();
    out.col(i) << Chain::link_velocity(z, i), q.cross(V(x.segment<3>(3 * i)));
  }
  return out;
}

TEST(PendulumChain, AccelerationsAreThoseOfDenseEquations) {
  const auto law = laws::check_law("tensions in O(k) give the dense accelerations", 1e-11, [] {
    const int k = *rc::gen::element(1, 2, 3, 7);
    Eigen::VectorXd mass(k), length(k);
    for (double& m : mass) m = std::exp(2 * laws::draw_uniform());
    for (double& l : length) l = std::exp(laws::draw_uniform());
    const Chain chain(mass, length, 9.81);
    const Points z = draw_state(k);
    Points rates = z;
    chain.space().generator(value(ChainVelocityField<any>(chain), z), z, rates);
    const Points dense = dense_accelerations(chain, z);
    return largest(rates - dense) / (1 + largest(dense));
  });
  EXPECT_TRUE(law.holds()) << law.worst;
}

TEST(PendulumChain, BothFormsAreOneMotion) {
  const auto law = laws::check_law("the Legendre transform carries one field to the other", 1e-8, [] {
    const int k = *rc::gen::element(1, 2, 5);
    const Chain chain(Eigen::VectorXd::LinSpaced(k, 0.5, 2), Eigen::VectorXd::LinSpaced(k, 1, 0.3), 9.81);
    const Points z = draw_state(k);
    constexpr double t = 1e-3;
    const auto moved = [&](double h) {
      Points at = z;
      LieGroupStep<CotangentSpheres<any>> step(chain.space(), lie_group_methods::munthe_kaas_54);
      ChainVelocityField<any> field(chain);
      step.advance(field, 0, h, at);
      return chain.to_momenta(at);
    };
    const Points slope = (8 * (moved(t) - moved(-t)) - (moved(2 * t) - moved(-2 * t))) / (12 * t);
    Points rates = z;
    const Points p = chain.to_momenta(z);
    chain.space().generator(value(ChainMomentumField<any>(chain), p), p, rates);
    return largest(slope - rates) / (1 + largest(rates));
  });
  EXPECT_TRUE(law.holds()) << law.worst;
}

TEST(PendulumChain, FixedAndRunTimeSizesAgree) {
  const Case c = named("pub_k2_equal");
  const PendulumChain<2> fixed(c.chain.mass, c.chain.length, c.chain.gravity);
  LieGroupIntegrator one(c.chain.space(), ChainMomentumField<any>(c.chain), lie_group_methods::commutator_free_4,
                         c.momenta, 0.01);
  LieGroupIntegrator two(fixed.space(), ChainMomentumField<2>(fixed), lie_group_methods::commutator_free_4,
                         PendulumChain<2>::Points(c.momenta), 0.01);
  ChainRattle<any> three(c.chain, c.velocities, 0.01);
  ChainRattle<2> four(fixed, c.velocities, 0.01);
  for (int n = 0; n < 100; ++n) {
    ASSERT_TRUE(one.advance().converged() && two.advance().converged());
    ASSERT_TRUE(three.advance().converged() && four.advance().converged());
  }
  EXPECT_GT(largest(one.point() - c.momenta), 0.1);
  EXPECT_LT(largest(one.point() - two.point()), 1e-12);
  EXPECT_LT(largest(three.point() - four.point()), 1e-12);
}

TEST(PendulumChain, SmallOscillationsHaveTheirFrequencies) {
  // The squares of the frequencies are eigenvalues of the accelerations of chains that hang at rest, each link in turn
  // displaced a little.
  const auto modes = records().at("closed_form").at("modes_uniform").at("vals");
  ASSERT_FALSE(modes.empty());
  for (const auto& [links, frequencies] : modes.items()) {
    const int k = std::stoi(links);
    const Chain chain(Eigen::VectorXd::Constant(k, 1.0 / k), Eigen::VectorXd::Constant(k, 1.0 / k), 9.81);
    // Accelerations of x displacements: a matrix, column by column.
    Eigen::MatrixXd stiffness(k, k);
    constexpr double small = 1e-5;
    for (int j = 0; j < k; ++j) {
      Points z = Points::Zero(6, k);
      for (int i = 0; i < k; ++i) z(2, i) = -1;
      z(0, j) = std::sin(small);
      z(2, j) = -std::cos(small);
      const Points u = value(ChainVelocityField<any>(chain), z);
      // q x w' = -q'' to first order.
      for (int i = 0; i < k; ++i) stiffness(i, j) = u(3, i) / small;
    }
    Eigen::VectorXd squares = Eigen::EigenSolver<Eigen::MatrixXd>(stiffness).eigenvalues().real();
    std::sort(squares.begin(), squares.end());
    for (int i = 0; i < k; ++i)
      EXPECT_NEAR(std::sqrt(std::abs(squares(i))), frequencies[i].get<double>(), 1e-7 * frequencies[i].get<double>())
          << k << " links, mode " << i + 1;
  }
}

TEST(PendulumChain, PeriodsAndPrecessionAreTheClosedForms) {
  const auto closed = records().at("closed_form");
  const auto integrate = [](const Chain& chain, const Points& start, double time) {
    ControlledLieGroupIntegrator out(chain.space(), ChainVelocityField<any>(chain), lie_group_methods::munthe_kaas_54,
                                     start, {.tolerance = 1e-14});
    EXPECT_TRUE(out.advance_to(time).converged());
    return out.point();
  };
  for (const auto& swing : closed.at("planar_period")) {
    const Chain chain(numbers({1}), numbers({swing.at("l")}), swing.at("g"));
    const double angle = swing.at("amplitude_from_bottom");
    Points z(6, 1);
    z << std::sin(angle), 0, -std::cos(angle), 0, 0, 0;
    EXPECT_LT(largest(integrate(chain, z, swing.at("period")) - z), 1e-9) << angle;
  }
  for (const auto& cone : closed.at("conical")) {
    const Chain chain(numbers({1}), numbers({cone.at("l")}), cone.at("g"));
    const double angle = cone.at("theta_from_plus_e3");
    const double rate = cone.at("precession_rate");
    const V q(std::sin(angle), 0, std::cos(angle));
    const V up(0, 0, rate);
    Points z(6, 1);
    z << q, up - q * q.dot(up);
    const Points end = integrate(chain, z, 1);
    EXPECT_NEAR(end(0, 0), q(0) * std::cos(rate), 1e-11) << angle;
    EXPECT_NEAR(end(1, 0), q(0) * std::sin(rate), 1e-11) << angle;
    EXPECT_NEAR(end(2, 0), q(2), 1e-11) << angle;
  }
}

TEST(PendulumChain, LightBobsOnRodsInLineLoseNoDigits) {
  // Estimates of the error that are made of cancellation would ask for a million steps.
  ControlledLieGroupIntegrator integrator(light_between().space(), ChainVelocityField<any>(light_between()),
                                          lie_group_methods::munthe_kaas_54, nearly_in_line(),
                                          {.tolerance = 1e-13, .first_step = 1e-4, .most_steps = 20'000});
  EXPECT_TRUE(integrator.advance_to(0.003).converged());
  EXPECT_LT(integrator.steps() + integrator.rejected(), 10'000);
}

TEST(PendulumChain, RefusesStartsOfAnotherSize) {
  const Chain chain = light_between();
  const Points three = Points::Zero(6, 3);
  EXPECT_THROW(ChainRattle<any>(chain, three, 0.01), std::invalid_argument);
  EXPECT_THROW(
      LieGroupIntegrator(chain.space(), ChainVelocityField<any>(chain), lie_group_methods::lie_euler, three, 0.01),
      std::invalid_argument);
  ControlledLieGroupIntegrator integrator(chain.space(), ChainVelocityField<any>(chain),
                                          lie_group_methods::munthe_kaas_54, nearly_in_line(), {});
  EXPECT_THROW(integrator.advance_to(std::nan("")), std::invalid_argument);
  EXPECT_THROW(integrator.advance_to(-1), std::invalid_argument);
}

TEST(PendulumChain, RefusesChainsThatAreNone) {
  EXPECT_THROW(Chain(numbers({1, 2}), numbers({1}), 9.81), std::invalid_argument);
  EXPECT_THROW(Chain(Eigen::VectorXd(), Eigen::VectorXd(), 9.81), std::invalid_argument);
  EXPECT_THROW(Chain(numbers({1, 0}), numbers({1, 1}), 9.81), std::invalid_argument);
  EXPECT_THROW(Chain(numbers({1}), numbers({std::nan("")}), 9.81), std::invalid_argument);
  EXPECT_THROW(Chain(numbers({1}), numbers({1}), std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace lagroid::pendulum_chain_tests::equations_tests
