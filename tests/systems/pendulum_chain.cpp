// Chains of spherical pendula: reference motions, closed forms, orders, and what a million steps keep.
#include <lagroid/core/testing/property.hpp>
#include <lagroid/solvers/lie_group/integrator.hpp>
#include <lagroid/solvers/testing/order_laws.hpp>
#include <lagroid/systems/pendulums/chain_rattle.hpp>
#include <lagroid/systems/pendulums/pendulum_chain.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>

#include <gtest/gtest.h>
#include <Eigen/Dense>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "../support/allocation_counter.hpp"

using namespace lagroid;

namespace {

constexpr int any = Eigen::Dynamic;
using Chain = PendulumChain<any>;
using Points = Chain::Points;
using V = Vector<double, 3>;
using Json = nlohmann::json;

Json records() {
  Json out;
  std::ifstream(std::string(LAGROID_TEST_DATA) + "/pendulum-chains.json") >> out;
  return out;
}

Eigen::VectorXd numbers(const std::vector<double>& v) {
  return Eigen::Map<const Eigen::VectorXd>(v.data(), Eigen::Index(v.size()));
}
Eigen::VectorXd list(const Json& array) { return numbers(array.get<std::vector<double>>()); }

struct Case {
  std::string name;
  Chain chain;
  double horizon, tolerance;
  Points velocities, momenta;          ///< at the start
  Points end_velocities, end_momenta;  ///< at the horizon
  double energy, vertical;

  explicit Case(const Json& record)
      : name(record.at("id")),
        chain(list(record.at("masses")), list(record.at("lengths")), record.at("g")),
        horizon(record.at("T")),
        tolerance(record.at("suggested_abs_tol")),
        velocities(points(record, "q0", "omega0")),
        momenta(points(record, "q0", "p0")),
        end_velocities(points(record, "qT", "omegaT")),
        end_momenta(points(record, "qT", "pT")),
        energy(record.at("E0")),
        vertical(record.at("Jz0")) {}

  static Points points(const Json& record, const char* q, const char* p) {
    Points z(6, record.at("k").get<int>());
    for (Eigen::Index i = 0; i < z.cols(); ++i) z.col(i) << list(record.at(q)[i]), list(record.at(p)[i]);
    return z;
  }
};

std::vector<Case> cases() {
  std::vector<Case> out;
  const Json all = records();
  for (const auto& record : all.at("cases")) out.emplace_back(record);
  return out;
}
Case named(const std::string& name) {
  for (auto& c : cases())
    if (c.name == name) return c;
  throw std::out_of_range(name);
}

/// F(z).
template <class F> Points value(F field, const Points& z) {
  Points u = z;
  field(0, z, u);
  return u;
}

/// Infinite where a number is none: comparisons pass over it.
double largest(const Points& difference) {
  return difference.allFinite() ? difference.cwiseAbs().maxCoeff() : std::numeric_limits<double>::infinity();
}

TEST(PendulumChain, EnergyMomentaAndLegendreTransformAreTheRecorded) {
  for (const auto& c : cases()) {
    EXPECT_NEAR(c.chain.energy(c.velocities), c.energy, 1e-14 * (1 + std::abs(c.energy))) << c.name;
    EXPECT_NEAR(c.chain.vertical_momentum(c.velocities), c.vertical, 1e-14 * (1 + std::abs(c.vertical))) << c.name;
    EXPECT_LT(largest(c.chain.to_momenta(c.velocities) - c.momenta), 1e-15) << c.name;
    EXPECT_LT(largest(c.chain.to_velocities(c.momenta) - c.velocities), 1e-13) << c.name;
  }
}

TEST(PendulumChain, ControlledStepsReachTheReferences) {
  for (const auto& c : cases()) {
    const auto end = [&](auto field, const Points& start) {
      ControlledLieGroupIntegrator integrator(c.chain.space(), field, lie_group_methods::munthe_kaas_54, start,
                                              {.tolerance = 1e-15});
      EXPECT_TRUE(integrator.advance_to(c.horizon).converged()) << c.name;
      return integrator.point();
    };
    EXPECT_LT(largest(end(ChainVelocityField<any>(c.chain), c.velocities) - c.end_velocities), c.tolerance) << c.name;
    EXPECT_LT(largest(end(ChainMomentumField<any>(c.chain), c.momenta) - c.end_momenta), c.tolerance) << c.name;
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

Points draw_state(int k) {
  Points z(6, k);
  for (auto column : z.colwise()) {
    for (double& x : column) x = laws::draw_uniform();
    column.head<3>().normalize();
    column.tail<3>() -= V(column.head<3>()) * column.head<3>().dot(column.tail<3>());
  }
  return z;
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

/// A light bob between the origin and a heavy one, on rods nearly in line.
Chain light_between() { return Chain(numbers({1e-8, 1}), numbers({1, 1}), 9.81); }
Points nearly_in_line() {
  Points z(6, 2);
  const auto direction = [](double theta, double phi) {
    return V(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
  };
  z.col(0) << direction(2.9, 0), V(0, 0.3, 0.1);
  z.col(1) << direction(2.9001, 0.3), V(0.1, 0.3, 0);
  light_between().space().project(z);
  return z;
}

TEST(PendulumChain, LightBobsOnRodsInLineLoseNoDigits) {
  // Estimates of the error that are made of cancellation would ask for a million steps.
  ControlledLieGroupIntegrator integrator(light_between().space(), ChainVelocityField<any>(light_between()),
                                          lie_group_methods::munthe_kaas_54, nearly_in_line(),
                                          {.tolerance = 1e-13, .first_step = 1e-4, .most_steps = 20'000});
  EXPECT_TRUE(integrator.advance_to(0.003).converged());
  EXPECT_LT(integrator.steps() + integrator.rejected(), 10'000);
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

TEST(PendulumChain, RefusesChainsThatAreNone) {
  EXPECT_THROW(Chain(numbers({1, 2}), numbers({1}), 9.81), std::invalid_argument);
  EXPECT_THROW(Chain(Eigen::VectorXd(), Eigen::VectorXd(), 9.81), std::invalid_argument);
  EXPECT_THROW(Chain(numbers({1, 0}), numbers({1, 1}), 9.81), std::invalid_argument);
  EXPECT_THROW(Chain(numbers({1}), numbers({std::nan("")}), 9.81), std::invalid_argument);
  EXPECT_THROW(Chain(numbers({1}), numbers({1}), std::nan("")), std::invalid_argument);
}

}  // namespace
