// Derivatives of runs by steps that are equal in another time, whose sizes and whose energy are made of the start.

#include "../differences.hpp"

#include <lagroid/solvers/sensitivity/times/timed_sensitivities.hpp>
#include <lagroid/systems/kepler.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <random>

namespace lagroid::sensitivity_transformed_tests {
namespace {

constexpr long steps = 40;

template <class Sys> RunFrom<Sys> orbit(double by, std::vector<std::string> names) {
  RunFrom<Sys> out{Sys(), {{0.6 + 0.1 * by, 0.1 * by}, {0.1 * by, 1.3}}, {}, std::move(names)};
  out.system.h = 0.1;
  out.configuration = Pair<2>::unit(out.start.object);
  return out;
}
RunFrom<Kepler> orbit(double by) {
  RunFrom<Kepler> out = orbit<Kepler>(by, {"strength"});
  out.system.strength = 1 + 0.1 * by;
  return out;
}

auto by(const Composition& composition) {
  return [&composition]<class Sys>(const RunFrom<Sys>& from) {
    return std::make_unique<LinearisedTransformedMotion<Sys>>(from.system, from.start, from.configuration, from.names,
                                                              EndAndTime(), composition);
  };
}

TEST(TransformedSensitivities, AreWhatDifferencesTendTo) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> draw(-1, 1);
  for (int trial = 0; trial < 3; ++trial) {
    const double drawn = draw(random);
    for (const Composition& composition : {compositions::single, compositions::suzuki, compositions::kahan_li_8})
      expect_exact_derivatives(orbit(drawn), by(composition), steps);
  }
}

/// The steps of a run whose energy and length in the other time were no functions of the start.
TEST(TransformedSensitivities, OfEnergyAndLengthHeldFixedMissTheDifferences) {
  const auto motion = by(compositions::single)(orbit(0.5));
  const Eigen::MatrixXd start = directions_of_start(*motion, 4);
  Eigen::MatrixXd all = start, held = start;
  for (long k = 0; k < steps; ++k) {
    ASSERT_TRUE(motion->advance().converged() && motion->linearise());
    for (int stage = 0; stage < motion->stages(); ++stage) all = motion->stage(stage).forward(all);
    held = motion->stage(motion->stages() - 1).forward(held);
  }
  const Propagated end = propagate_forward(*by(compositions::single)(orbit(0.5)), steps, start);
  EXPECT_LT((all - end.end).norm(), 1e-14 * all.norm());
  EXPECT_GT((held - all).topRows(5).norm(), 1e-2 * all.norm());
}

TEST(TransformedSensitivities, AreSymplecticOnThePhaseSpaceExtendedByTimeAndEnergy) {
  const auto motion = by(compositions::suzuki)(orbit(0.5));
  Eigen::MatrixXd form = Eigen::MatrixXd::Zero(6, 6);  // d mu ^ dv - dE ^ dt
  for (int i = 0; i < 2; ++i) {
    form(i, 2 + i) = -1;
    form(2 + i, i) = 1;
  }
  form(4, 5) = 1;
  form(5, 4) = -1;
  for (long k = 0; k < steps; ++k) {
    ASSERT_TRUE(motion->advance().converged() && motion->linearise());
    const Eigen::MatrixXd step =
        motion->stage(motion->stages() - 1).forward(Eigen::MatrixXd::Identity(8, 8)).topLeftCorner(6, 6);
    EXPECT_LT((step.transpose() * form * step - form).norm(), 1e-13 * step.squaredNorm()) << k;
  }
}

/// What is observed between two nodes, by the start.
TEST(TransformedSensitivities, OfPartsOfStepsAreWhatDifferencesTendTo) {
  for (const long node : {0L, 7L}) {
    const auto seen = [&](LinearisedMotion& motion) {
      for (long k = 0; k < node; ++k) EXPECT_TRUE(motion.advance().converged());
      return motion.observe_later(node == 0 ? 0.06 : 0.75).value();
    };
    const auto motion = by(compositions::suzuki)(orbit(0.3));
    EXPECT_LT(motion->time(), 0.06);
    const NodeValues here = seen(*motion);
    if (node > 0) {
      EXPECT_LT(motion->time(), 0.75);
      ASSERT_TRUE(motion->advance().converged());
      EXPECT_GT(motion->time(), 0.75);
    }
    const auto before = by(compositions::suzuki)(orbit(0.3));
    const Eigen::MatrixXd to_node = propagate_forward(*before, node, directions_of_start(*before, 4)).end;
    for (int which = 0; which < 5; ++which) {
      const auto at = [&](double by_much) -> Eigen::VectorXd {
        return seen(*by(compositions::suzuki)(orbit(0.3).moved(which, by_much))).values;
      };
      const Eigen::VectorXd difference = laws::detail::extrapolated_difference(at, 4e-4);
      EXPECT_LT((here.derivatives * to_node.col(which) - difference).norm(), 1e-8 * std::max(1.0, difference.norm()))
          << node << ' ' << which;
    }
  }
}

TEST(TransformedSensitivities, SayWhereTheAttractionEnds) {
  RunFrom<Kepler> from = orbit(0);
  from.system.strength = -1;
  const Propagated end = propagate_forward(*by(compositions::single)(from), steps, Eigen::MatrixXd::Identity(8, 8));
  EXPECT_EQ(end.status, SolveStatus::left_domain);
  EXPECT_FALSE(by(compositions::single)(from)->observe_later(0.01).has_value());
  const Sensitivities run =
      sensitivities<TimeMode::transformed>(orbit(0).system, orbit(0).start, {.steps = 3, .parameters = {"strength"}});
  EXPECT_EQ(run.by_start.rows(), 7);
  EXPECT_EQ(run.by_start.cols(), 4);
}

/// Its flows know the strength, its energies read it as a plain number.
struct Deaf : MechanicalSystem<Deaf, 2> {
  double strength = 1;
  static auto parameters() {
    return std::tuple(parameter("strength", &Deaf::strength, "m^3/s^2", "of the attraction"));
  }
  static double mass() { return 1; }
  static constexpr bool attractive = true;
  template <class S> S potential(const Vector<S, 2>& q) const {
    using std::sqrt;
    return S(-strength) / sqrt(q.squaredNorm());
  }
  template <class S> Vector<S, 2> gradient(const Vector<S, 2>& q) const {
    using std::sqrt;
    const S square = q.squaredNorm();
    return q * (constant<S>(varied<S>(strength)) / (square * sqrt(square)));
  }
};
TEST(TransformedSensitivities, RefuseAParameterThatEnergiesReadAsAPlainNumber) {
  EXPECT_THROW(by(compositions::single)(orbit<Deaf>(0, {"strength"})), WithoutDerivative);
  EXPECT_TRUE(by(compositions::single)(orbit<Deaf>(0, {}))->advance().converged());
  EXPECT_THROW(by(compositions::single)(orbit<Deaf>(0, {"mass"})), std::invalid_argument);
}

}  // namespace
}  // namespace lagroid::sensitivity_transformed_tests
