// Derivatives of runs by the classical Runge-Kutta method, which drift off the groupoid.

#include "../differences.hpp"

#include <lagroid/solvers/sensitivity/explicit/linearised_runge_kutta.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/damped_pendulum.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <tuple>

namespace lagroid::sensitivity_runge_kutta_tests {
namespace {

constexpr long steps = 40;

/// On Pair(Q).
template <class Sys> RunFrom<Sys> from_rest(Sys system, const State<typename Sys::GroupoidType>& start) {
  system.h = 0.1;
  const auto names = all_parameters(system).names;
  return {system, start, system.groupoid.unit(start.object), names};
}
RunFrom<HeavyTop> top(double by) {
  RunFrom<HeavyTop> out{HeavyTop(), {{}, {0.3 + 0.1 * by, 1.5, 0.4}}, {}, all_parameters(HeavyTop()).names};
  out.system.h = 0.1;
  out.configuration = {SO3::exp(Vector<double, 3>(0.2, by, 0.1)), Vector<double, 3>(0, 0, 1)};
  out.start.object = out.system.groupoid.target(out.configuration);
  return out;
}

const auto by_runge_kutta = []<class Sys>(const RunFrom<Sys>& from) {
  return std::make_unique<LinearisedRungeKutta<Sys>>(from.system, from.start, from.configuration, from.names,
                                                     EndOfRun());
};

TEST(RungeKuttaSensitivities, AreWhatDifferencesTendTo) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> draw(-1, 1);
  for (int trial = 0; trial < 2; ++trial) {
    const double by = draw(random);
    expect_exact_derivatives(from_rest(DampedPendulum(), {Vector<double, 1>(0.9), Vector<double, 1>(by)}),
                             by_runge_kutta, steps);
    expect_exact_derivatives(from_rest(SphericalPendulum(), {{0.6, 0, -0.8}, {0.4, 0.7 + 0.1 * by, 0.3}}),
                             by_runge_kutta, steps);
    expect_exact_derivatives(top(by), by_runge_kutta, steps);
  }
}

/// Of what a step does, the part along the groupoid.
struct AlongAlone : CoordinateChart<HeavyTop> {
  using CoordinateChart<HeavyTop>::CoordinateChart;
  template <class S> Vector<S, states> displacement(const NodeOver<G, S>& node) const {
    Vector<S, states> x = CoordinateChart<HeavyTop>::displacement(node);
    x.template tail<coordinates - n>().setConstant(S(0.0));
    return x;
  }
};
struct StepsAlongAlone : detail::RungeKuttaSteps<HeavyTop> {
  using Chart = AlongAlone;
  using detail::RungeKuttaSteps<HeavyTop>::RungeKuttaSteps;
};
/// The attitude of the end is no rotation any more: what lies across the groupoid has to be carried.
TEST(RungeKuttaSensitivities, WithoutWhatLiesAcrossMissTheDifferences) {
  const auto along_alone = [](const RunFrom<HeavyTop>& from) {
    return std::make_unique<LinearisedExplicit<HeavyTop, StepsAlongAlone>>(
        from.system, StepsAlongAlone(from.system, from.start, from.configuration), from.names, EndOfRun());
  };
  EXPECT_GT(missed_differences(top(0.5), along_alone, by_runge_kutta, steps), 1e-7);
}

/// Rates for doubles alone.
struct Plain : Kepler {
  Rates<Pair<2>> rates(const State<Pair<2>>& z) const { return Kepler::rates(z); }
};
static_assert(HasVariedRates<Kepler> && HasRates<Plain> && !HasVariedRates<Plain>);

/// A damping that is read as a plain number.
struct Forgetful : DampedPendulum {
  template <class S = double> RatesOver<Pair<1>, S> rates(const State<Pair<1>, S>& s) const {
    RatesOver<Pair<1>, S> free = Pendulum::rates(s);
    free.momentum -= free.velocity * damping;
    return free;
  }
};
TEST(RungeKuttaSensitivities, RefuseAParameterThatRatesReadAsAPlainNumber) {
  const auto motion = by_runge_kutta(from_rest(Forgetful(), {Vector<double, 1>(0.9), Vector<double, 1>(0.3)}));
  ASSERT_TRUE(motion->advance().converged());
  EXPECT_THROW(motion->linearise(), WithoutDerivative);
}

}  // namespace
}  // namespace lagroid::sensitivity_runge_kutta_tests
