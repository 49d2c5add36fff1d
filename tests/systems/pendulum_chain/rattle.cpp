// RATTLE of the chain of pendulums.
#include "chains.hpp"

#include <lagroid/core/testing/property.hpp>
#include <lagroid/solvers/lie_group/integrator.hpp>
#include <lagroid/solvers/testing/order_laws.hpp>
#include <lagroid/systems/pendulums/chain_rattle.hpp>
#include <lagroid/systems/pendulums/pendulum_chain.hpp>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <cmath>
#include <vector>

namespace lagroid::pendulum_chain_tests::rattle_tests {
namespace {

TEST(ChainRattle, IsReversible) {
  const Case c = named("pub_k3_mixed");
  ChainRattle<any> there(c.chain, c.velocities, 0.005);
  for (int n = 0; n < 200; ++n) ASSERT_TRUE(there.advance().converged());
  Points turned = there.point();
  turned.bottomRows<3>() *= -1;
  ChainRattle<any> back(c.chain, turned, 0.005);
  for (int n = 0; n < 200; ++n) ASSERT_TRUE(back.advance().converged());
  Points end = back.point();
  end.bottomRows<3>() *= -1;
  EXPECT_LT(largest(end - c.velocities), 1e-9);
}

TEST(ChainRattle, ComposedHasItsOrderAndKeepsTheMomentum) {
  const Case c = named("pub_k2_equal");
  ControlledLieGroupIntegrator exact(c.chain.space(), ChainVelocityField<any>(c.chain),
                                     lie_group_methods::munthe_kaas_54, c.velocities, {.tolerance = 1e-15});
  ASSERT_TRUE(exact.advance_to(0.5).converged());
  const auto flat = [](const Points& z) -> Eigen::VectorXd {
    return Eigen::Map<const Eigen::VectorXd>(z.data(), z.size());
  };
  for (const Composition& composition : compositions::all) {
    const auto end = [&](int steps) {
      ChainRattle<any> integrator(c.chain, c.velocities, 0.5 / steps, composition);
      for (int n = 0; n < steps; ++n) EXPECT_TRUE(integrator.advance().converged());
      EXPECT_NEAR(c.chain.vertical_momentum(integrator.point()), c.vertical, 1e-13) << composition.name;
      return flat(integrator.point());
    };
    const auto report = laws::order_laws(ChainRattle<any>::traits(composition),
                                         {end, flat(exact.point()), composition.order > 4 ? 6 : 12, 2e-12});
    EXPECT_TRUE(report.holds()) << composition.name << ": " << report;
  }
}

TEST(ChainRattle, AStageThatFailsUndoesTheStep) {
  const Case c = named("pub_k2_equal");
  ChainRattle<any> integrator(c.chain, c.velocities, 0.9, compositions::suzuki);
  StepReport report;
  Points before = integrator.point();
  while ((report = integrator.advance()).converged() && integrator.index() < 100) before = integrator.point();
  ASSERT_FALSE(report.converged());
  EXPECT_EQ(largest(integrator.point() - before), 0);
}

TEST(ChainRattle, StepsAreSolvedToRoundOffBesideLightBobs) {
  for (const double h : {1e-5, 1e-6}) {
    const Chain chain = light_between();
    ChainRattle<any> integrator(chain, nearly_in_line(), h);
    const double vertical = chain.vertical_momentum(integrator.point());
    StepReport report;
    double off = 0;
    int taken = 0;
    for (; taken < 20'000 && (report = integrator.advance()).converged(); ++taken)
      for (int i = 0; i < 2; ++i) off = std::max(off, std::abs(integrator.directions().col(i).squaredNorm() - 1));
    // Until the rods are in line, where the light bob whips round within a step.
    EXPECT_NEAR(taken * h, 0.01648, 2e-5);
    EXPECT_EQ(report.status, SolveStatus::left_domain);
    EXPECT_LT(off, 3e-15) << h;
    EXPECT_NEAR(chain.vertical_momentum(integrator.point()), vertical, 1e-10 * std::abs(vertical)) << h;
  }
}

TEST(ChainRattle, RandomChainsKeepTheirRodsAndMomentum) {
  long asked = 0;
  long taken = 0;
  const auto law = laws::check_law("every accepted step keeps |q| = 1 and J_z", 1e-11, [&] {
    const int k = *rc::gen::element(2, 3, 5);
    Eigen::VectorXd mass(k), length(k);
    for (double& m : mass) m = std::pow(10.0, 2 * laws::draw_uniform());
    for (double& l : length) l = std::pow(10.0, 0.5 * laws::draw_uniform());
    const Chain chain(mass, length, 9.81);
    const Points start = draw_state(k);
    ChainRattle<any> integrator(chain, start, std::pow(10.0, -3 + laws::draw_uniform()));
    const double vertical = chain.vertical_momentum(start);
    const double size = chain.momentum_size(start);
    double worst = 0;
    asked += 500;
    for (int n = 0; n < 500 && integrator.advance().converged(); ++n) {
      ++taken;
      for (int i = 0; i < k; ++i)
        worst = std::max(worst, 1e3 * std::abs(integrator.directions().col(i).squaredNorm() - 1));
      worst = std::max(worst, std::abs(chain.vertical_momentum(integrator.point()) - vertical) / size);
    }
    return worst;
  });
  EXPECT_TRUE(law.holds()) << law.worst;
  EXPECT_GT(taken, asked / 2);
}

/// The canonical two-form of (T*S^2)^k on tangent vectors a, b at (q, p).
double canonical_form(const Points& a, const Points& b) {
  double sum = 0;
  for (Eigen::Index i = 0; i < a.cols(); ++i)
    sum += a.col(i).head<3>().dot(b.col(i).tail<3>()) - a.col(i).tail<3>().dot(b.col(i).head<3>());
  return sum;
}

TEST(ChainRattle, IsSymplecticAndLieGroupMethodsAreNot) {
  const Case c = named("pub_k2_equal");
  const auto space = c.chain.space();
  const auto tangents = [&] {
    // Along generators, which span the tangent space.
    std::vector<Points> out;
    for (Eigen::Index i = 0; i < c.momenta.size(); ++i) {
      Points u = space.zero_algebra();
      u.data()[i] = 1;
      out.push_back(u);
    }
    return out;
  }();
  const auto defect = [&](const auto& flow) {
    constexpr double small = 1e-4;
    const auto image = [&](const Points& u) {
      const auto at = [&](double t) {
        Points z = c.momenta;
        space.act(u * t, z);
        return flow(z);
      };
      return Points((8 * (at(small) - at(-small)) - (at(2 * small) - at(-2 * small))) / (12 * small));
    };
    double worst = 0;
    std::vector<Points> images, before;
    for (const auto& u : tangents) {
      images.push_back(image(u));
      Points v = c.momenta;
      space.generator(u, c.momenta, v);
      before.push_back(v);
    }
    for (std::size_t i = 0; i < images.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        worst = std::max(worst, std::abs(canonical_form(images[i], images[j]) - canonical_form(before[i], before[j])));
    return worst;
  };
  constexpr double h = 0.1;
  const auto rattle = [&](const Points& z) {
    ChainRattle<any> integrator(c.chain, c.chain.to_velocities(z), h);
    EXPECT_TRUE(integrator.advance().converged());
    return c.chain.to_momenta(integrator.point());
  };
  const auto commutator_free = [&](const Points& z) {
    LieGroupIntegrator integrator(space, ChainMomentumField<any>(c.chain), lie_group_methods::commutator_free_4, z, h);
    integrator.advance();
    return integrator.point();
  };
  EXPECT_LT(defect(rattle), 1e-9);
  EXPECT_GT(defect(commutator_free), 1e-6);
}

TEST(ChainRattle, StepsThatAreTooLargeAreTypedAndAdvanceNothing) {
  const Case c = named("pub_k2_equal");
  ChainRattle<any> integrator(c.chain, c.velocities, 5);
  const Points before = integrator.point();
  const auto report = integrator.advance();
  EXPECT_FALSE(report.converged());
  EXPECT_EQ(integrator.index(), 0);
  EXPECT_EQ(largest(integrator.point() - before), 0);
  Points wild = c.velocities;
  wild.bottomRows<3>() *= 1e200;
  ChainRattle<any> lost(c.chain, wild, 0.01);
  EXPECT_FALSE(lost.advance().converged());
}

}  // namespace
}  // namespace lagroid::pendulum_chain_tests::rattle_tests
