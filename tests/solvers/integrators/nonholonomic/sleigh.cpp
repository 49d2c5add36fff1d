// The Chaplygin sleigh: its closed form, order, momentum equation, and reactions that do no work.
#include "../../../support/broken.hpp"
#include "../../../support/draws.hpp"
#include "../../../support/integrating.hpp"

#include <lagroid/solvers/testing/dalembert_laws.hpp>
#include <lagroid/systems/rolling/chaplygin_sleigh.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace lagroid;

namespace nonholonomic_sleigh_tests {
namespace {

static_assert(!HasAnnihilator<ChaplyginSleigh>);

/// Derivatives by hand with a reaction that turns the sleigh too.
struct ReactionWithTorque : ChaplyginSleigh {
  TwoSided<3, 1> two_sided(const Matrix<double, 3, 3>& g, const Multipliers& lambda) const {
    auto d = automatic_two_sided(static_cast<const ChaplyginSleigh&>(*this), g, lambda);
    const Vector<double, 3> omega(1, 0, 1);
    d.source_gradient += (omega - d.constraint_source.col(0)) * lambda(0);
    d.constraint_source.col(0) = omega;
    return d;
  }
  Step<ReactionWithTorque> first_guess(const State<SE2>& s) const {
    return {ChaplyginSleigh::first_guess(s).arrow, Multipliers::Zero()};
  }
};

/// Derivatives by hand that take a millimetre to the side for none.
struct Sidling : ChaplyginSleigh {
  TwoSided<3, 1> two_sided(const Matrix<double, 3, 3>& g, const Multipliers& lambda) const {
    auto d = automatic_two_sided(static_cast<const ChaplyginSleigh&>(*this), g, lambda);
    d.constraint(0) -= 1e-3;
    return d;
  }
  Step<Sidling> first_guess(const State<SE2>& s) const {
    return {ChaplyginSleigh::first_guess(s).arrow, Multipliers::Zero()};
  }
};

TEST(ChaplyginSleigh, ReferenceIsTheClosedForm) {
  ChaplyginSleigh sleigh;
  sleigh.mass = 1.3;
  sleigh.inertia = 0.6;
  sleigh.offset = 0.4;
  const auto start = sleigh.sliding(-0.8, -0.6);
  for (const double t : {0.5, 2.0, 8.0}) {
    Matrix<double, 3, 3> pose = Matrix<double, 3, 3>::Identity();
    EXPECT_LT((sleigh.velocities(sleigh.reference(start, pose, t)) - sleigh.closed_form(start, t)).norm(), 1e-12) << t;
  }
}

TEST(ChaplyginSleigh, OrderTwoInPoseAndReportedMomentum) {
  ChaplyginSleigh sleigh;
  const auto start = sleigh.sliding(1.0, -0.6);
  Matrix<double, 3, 3> pose = Matrix<double, 3, 3>::Identity();
  const auto exact = sleigh.reference(start, pose, 5.0);
  for (const auto map : {Retraction::exponential, Retraction::cayley}) {
    sleigh.map = map;
    const double order = measured_order(sleigh, start, 5.0, 100, [&](const auto& s, const auto& end) {
      return (end.configuration - pose).norm() + (reported_momentum(s, end) - exact.momentum).norm();
    });
    EXPECT_NEAR(order, 2, 0.05);
  }
}

TEST(ChaplyginSleigh, ApproachesAStraightLineAndKeepsItsEnergyInABand) {
  ChaplyginSleigh sleigh;
  const auto start = sleigh.sliding(1.0, -0.6);
  std::vector<double> bands;
  for (const double h : {0.05, 0.025}) {
    sleigh.h = h;
    auto integrator = integrator_from(sleigh, start);
    double band = 0;
    auto state = start;
    for (long k = 0; k < std::lround(40 / h); ++k) {
      ASSERT_TRUE(integrator.advance().converged());
      state.momentum = reported_momentum(sleigh, integrator.point());
      band = std::max(band, std::abs(sleigh.energy(state) - sleigh.energy(start)));
    }
    bands.push_back(band);
    const auto v = sleigh.velocities(state);
    EXPECT_NEAR(v(0), 0, 1e-12);
    EXPECT_NEAR(v(1), std::sqrt(2 * sleigh.energy(start)), 2e-3);
  }
  EXPECT_NEAR(std::log2(bands[0] / bands[1]), 2, 0.05);
}

/// The largest deviation of a quantity over 300 steps, relative to its size.
template <class Sys>
double drift_of(const Quantity<Sys>& quantity, const Sys& system, const State<typename Sys::GroupoidType>& start) {
  return laws::detail::drift(system, quantity, start, 300);
}

TEST(MomentumEquation, HoldsAlongSectionsOfTheDistribution) {
  const ChaplyginSleigh sleigh;
  const auto start = sleigh.sliding(1.0, -0.6);
  for (const auto& section : sleigh.sections()) {
    EXPECT_LT(drift_of(momentum_balance(sleigh, section), sleigh, start), 1e-14) << section.name;
    EXPECT_GT(drift_of(section.quantity(), sleigh, start), 0.1) << "the momentum itself is not conserved";
  }
}

TEST(BrokenMomentumEquation, AcrossTheDistributionTheReactionActs) {
  const ChaplyginSleigh sleigh;
  const Symmetry<ChaplyginSleigh> sideways{"sideways", [](const ObjectOf<SE2>&) { return Vector<double, 3>(0, 0, 1); }};
  EXPECT_GT(drift_of(momentum_balance(sleigh, sideways), sleigh, sleigh.sliding(1.0, -0.6)), 0.1);
}

TEST(Nonholonomic, NoVirtualWorkWhereASleighSlides) {
  const ChaplyginSleigh sleigh;
  const auto sliding =
      laws::dalembert_laws(sleigh, [&] { return sleigh.sliding(laws::draw_uniform(), 2 * laws::draw_uniform()); });
  EXPECT_TRUE(sliding.holds()) << sliding;
}

TEST(BrokenReaction, WithATorqueDoesVirtualWork) {
  const ReactionWithTorque sleigh;
  const auto report = laws::dalembert_laws(sleigh, [&] { return sleigh.sliding(1 + 0.5 * laws::draw_uniform(), 1.0); });
  EXPECT_TRUE(laws::seen_broken(report.law("no virtual work"))) << report;
  EXPECT_TRUE(laws::seen_broken(report.law("reported momenta keep the constraints"))) << report;
  EXPECT_TRUE(report.law("arrows keep the constraints").holds()) << report;
}

TEST(BrokenConstraint, ArrowsThatMoveSideways) {
  const Sidling sleigh;
  const auto report = laws::dalembert_laws(sleigh, [&] { return sleigh.sliding(1.0, laws::draw_uniform()); });
  EXPECT_TRUE(laws::seen_broken(report.law("arrows keep the constraints"))) << report;
  EXPECT_TRUE(report.law("no virtual work").holds()) << report;
}

}  // namespace
}  // namespace nonholonomic_sleigh_tests
