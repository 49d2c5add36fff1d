// Methods for the chain of pendulums: orders, and a million steps.
#include "chains.hpp"

#include <lagroid/solvers/lie_group/integrator.hpp>
#include <lagroid/solvers/testing/order_laws.hpp>
#include <lagroid/systems/pendulums/chain_rattle.hpp>
#include <lagroid/systems/pendulums/pendulum_chain.hpp>
#include <lagroid/systems/spheres/sphere_integrator.hpp>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <cmath>

#include "../../support/allocation_counter.hpp"

namespace lagroid::pendulum_chain_tests::methods_tests {
namespace {

TEST(PendulumChain, ControlledStepsReachTheReferences) {
  for (const auto& c : cases()) {
    const auto end = [&](auto field, const Points& start) {
      ControlledLieGroupIntegrator integrator(c.chain.space(), field, lie_group_methods::munthe_kaas_54, start,
                                              {.tolerance = 3e-15});
      EXPECT_TRUE(integrator.advance_to(c.horizon).converged()) << c.name;
      return integrator.point();
    };
    EXPECT_LT(largest(end(ChainVelocityField<any>(c.chain), c.velocities) - c.end_velocities), c.tolerance) << c.name;
    for (const SphereForm form : {SphereForm::velocities, SphereForm::momenta}) {
      const bool momenta = form == SphereForm::momenta;
      const auto extrapolated =
          make_chain_integrator(c.chain, momenta ? c.momenta : c.velocities,
                                {.method = "extrapolation", .form = form, .step = c.horizon, .tolerance = 1e-15});
      EXPECT_TRUE(extrapolated->advance().converged()) << c.name;
      EXPECT_LT(largest(extrapolated->point() - (momenta ? c.end_momenta : c.end_velocities)), 10 * c.tolerance)
          << c.name << momenta;
    }
    EXPECT_LT(largest(end(ChainMomentumField<any>(c.chain), c.momenta) - c.end_momenta), c.tolerance) << c.name;
  }
}

TEST(PendulumChain, EveryMethodHasItsOrderOnBothForms) {
  for (const char* name : {"pub_k1_generic", "pub_k2_equal", "pub_k3_mixed"}) {
    const Case c = named(name);
    const auto problem = [&](const auto& end, int coarsest) {
      return laws::OrderProblem{end, end(0), coarsest, 1e-11};
    };
    const auto flat = [](const Points& z) -> Eigen::VectorXd {
      return Eigen::Map<const Eigen::VectorXd>(z.data(), z.size());
    };
    const auto by = [&](auto field, const Points& start, const LieGroupMethod& method) {
      const double horizon = method.order == 5 ? 1 : 0.3;
      return [&c, field, start, method, horizon, flat](int steps) {
        const bool reference = steps == 0;
        LieGroupIntegrator integrator(c.chain.space(), field, reference ? lie_group_methods::munthe_kaas_54 : method,
                                      start, horizon / (reference ? 1500 : steps));
        for (int n = 0; n < (reference ? 1500 : steps); ++n) integrator.advance();
        return flat(integrator.point());
      };
    };
    for (const auto& method : lie_group_methods::all) {
      // With three links order 5 shows only where round-off does.
      if (method.order == 5 && c.chain.links() > 2) continue;
      const int coarsest = method.order == 1 ? 400 : method.order == 5 ? 20 : 40;
      for (const auto& report :
           {laws::order_laws(traits_of(method),
                             problem(by(ChainVelocityField<any>(c.chain), c.velocities, method), coarsest)),
            laws::order_laws(traits_of(method),
                             problem(by(ChainMomentumField<any>(c.chain), c.momenta, method), coarsest))})
        EXPECT_TRUE(report.holds()) << name << ": " << report;
    }
    const auto exact = by(ChainVelocityField<any>(c.chain), c.velocities, lie_group_methods::commutator_free_4)(0);
    const auto rattle = laws::order_laws(ChainRattle<any>(c.chain, c.velocities, 1).traits(),
                                         {[&](int steps) {
                                            ChainRattle<any> integrator(c.chain, c.velocities, 0.3 / steps);
                                            for (int n = 0; n < steps; ++n) integrator.advance();
                                            return flat(integrator.point());
                                          },
                                          exact, 40, 1e-11});
    EXPECT_TRUE(rattle.holds()) << name << ": " << rattle;
  }
}

TEST(PendulumChain, AMillionLieGroupStepsStayOnTheManifold) {
  const Case c = named("pub_k1_generic");
  const auto off = [&](auto field, const Points& start) {
    LieGroupIntegrator integrator(c.chain.space(), field, lie_group_methods::commutator_free_4, start, 0.01);
    double worst = 0;
    for (int n = 0; n < 1'000'000; ++n) {
      if (!integrator.advance().converged()) return 1.0;
      const V q = integrator.point().col(0).template head<3>();
      const V p = integrator.point().col(0).template tail<3>();
      worst = std::max({worst, std::abs(q.squaredNorm() - 1), std::abs(q.dot(p)) / (1 + p.norm())});
    }
    return worst;
  };
  EXPECT_LT(off(ChainVelocityField<any>(c.chain), c.velocities), 2e-15);
  EXPECT_LT(off(ChainMomentumField<any>(c.chain), c.momenta), 2e-15);
}

TEST(PendulumChain, AMillionVariationalStepsBoundTheEnergyAndKeepTheMomentum) {
  for (const char* name : {"pub_k1_generic", "pub_k2_equal"}) {
    const Case c = named(name);
    ChainRattle<any> integrator(c.chain, c.velocities, 0.01);
    double halves[2] = {0, 0};
    double momentum = 0;
    double off = 0;
    constexpr int steps = 1'000'000;
    for (int n = 0; n < steps; ++n) {
      ASSERT_TRUE(integrator.advance().converged()) << name;
      if (n % 10 != 0) continue;
      const Points z = integrator.point();
      double& error = halves[2 * n / steps];
      error = std::max(error, std::abs(c.chain.energy(z) - c.energy));
      momentum = std::max(momentum, std::abs(c.chain.vertical_momentum(z) - c.vertical));
      for (int i = 0; i < c.chain.links(); ++i)
        off = std::max({off, std::abs(z.col(i).head<3>().squaredNorm() - 1),
                        std::abs(integrator.directions().col(i).dot(integrator.velocities().col(i)))});
    }
    EXPECT_LT(halves[0], 0.06) << name;
    EXPECT_LT(halves[1], 1.2 * halves[0]) << name;
    EXPECT_LT(momentum, 1e-12) << name;
    EXPECT_LT(off, 2e-15) << name;
  }
}

TEST(PendulumChain, LieGroupMethodsLetTheEnergyDrift) {
  // What the variational method's bound is compared with.
  const Case c = named("pub_k1_generic");
  LieGroupIntegrator integrator(c.chain.space(), ChainVelocityField<any>(c.chain), lie_group_methods::commutator_free_4,
                                c.velocities, 0.01);
  double halves[2] = {0, 0};
  for (int n = 0; n < 200'000; ++n) {
    integrator.advance();
    double& error = halves[n / 100'000];
    error = std::max(error, std::abs(c.chain.energy(integrator.point()) - c.energy));
  }
  EXPECT_GT(halves[1], 1.5 * halves[0]);
}

TEST(PendulumChain, StepsAllocateNothing) {
  if (allocation_count() < 0) GTEST_SKIP() << "allocations are not counted here";
  const Case c = named("pub_k10");
  LieGroupIntegrator lie(c.chain.space(), ChainMomentumField<any>(c.chain), lie_group_methods::commutator_free_4,
                         c.momenta, 1e-3);
  ControlledLieGroupIntegrator controlled(c.chain.space(), ChainVelocityField<any>(c.chain),
                                          lie_group_methods::munthe_kaas_54, c.velocities, {.tolerance = 1e-10});
  ChainRattle<any> rattle(c.chain, c.velocities, 1e-3);
  lie.advance();
  rattle.advance();
  controlled.advance_to(0.01);
  const long before = allocation_count();
  for (int n = 0; n < 50; ++n) {
    lie.advance();
    rattle.advance();
  }
  controlled.advance_to(0.05);
  EXPECT_EQ(allocation_count(), before);
}

}  // namespace
}  // namespace lagroid::pendulum_chain_tests::methods_tests
