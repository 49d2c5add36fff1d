// Optimal control of a satellite: cheapest and fastest turns, bounded torques, a direction to be kept out.
#include "support.hpp"

#include <lagroid/solvers/control/displaced_jet.hpp>
#include <lagroid/systems/control/flows/satellite_turn.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lagroid::optimal_control_attitudes_tests {
namespace {

using control_tests::expect_laws;
using control_tests::expect_second_order;
using States = FlowStates<SatelliteTurn::GroupoidType>;

ControlTask<SatelliteTurn> turn(const Vector<double, 3>& rotation, double duration, const SatelliteTurn& system = {}) {
  States::State end;
  end << rotation, 0, 0, 0;
  return {system, States::arrow(States::State::Zero(), end, system.avoided), duration};
}

TEST(SatelliteTurns, CheapestWithAndWithoutBounds) {
  auto task = turn(2 * Vector<double, 3>(1, 2, 3).normalized(), 5);
  expect_second_order("free", task, 2.227141563828326, 5.6, true, 1);
  task.lower.setConstant(-0.5);
  task.upper.setConstant(0.5);
  expect_second_order("bounded", task, 2.8171354369898496, 16.5, true, 1);
}

// A half turn of a ball about one axis: three torques at once are faster than that one alone, by 0.3.
TEST(SatelliteTurns, TheFastestHalfTurnIsAboutNoFixedAxis) {
  SatelliteTurn ball;
  ball.inertia.setOnes();
  ball.cost_of = ControlCost::time;
  auto task = turn({0, 0, std::numbers::pi - 1e-9}, 4, ball);
  task.duration_is_free = true;
  task.lower.setConstant(-1);
  task.upper.setConstant(1);
  const auto found = search_control(task, 100, {.starts = 4});
  ASSERT_FALSE(found.minima.empty());
  EXPECT_NEAR(found.minima.front().report.cost, 3.243083277452351, 5 * 3.1 / 1e4);
  EXPECT_LT(found.minima.front().report.cost, 2 * std::sqrt(std::numbers::pi) - 0.25);
}

TEST(SatelliteTurns, KeepOutOfACone) {
  SatelliteTurn satellite;
  satellite.avoided << 0.8369922322356853, 0.09964193240901018, 0.5380664350086549;
  satellite.cone = 0.4363323129985824;
  const auto task = turn(2 * Vector<double, 3>(0.2, 1, 0.1).normalized(), 5, satellite);
  expect_second_order("cone", task, 1.5678571415183247, 2, false, 1);
  expect_laws(task, 20);
}

/// The largest difference of values, gradients and Hessians of the coordinates.
template <class G, class J> double distance(const G& groupoid, const ArrowOf<G, J>& g, const ArrowOf<G, J>& h) {
  const auto x = groupoid.coordinates_of_arrow(g);
  const auto y = groupoid.coordinates_of_arrow(h);
  double most = 0;
  for (int i = 0; i < x.size(); ++i) {
    most = std::max({most, std::abs(x(i).value - y(i).value), (x(i).gradient() - y(i).gradient()).cwiseAbs().maxCoeff(),
                     (x(i).hessian() - y(i).hessian()).cwiseAbs().maxCoeff()});
  }
  return most;
}

// Factor by factor of a product, in few directions each, or all at once by the groupoid.
TEST(DisplacedJets, AreTheTranslationsOfTheGroupoid) {
  using G = SatelliteTurn::GroupoidType;
  using J = SecondJet<double, 2 * G::dimension>;
  const G groupoid;
  States::State end;
  end << 1.1, -0.4, 0.7, 0.3, 0.2, -0.5;
  const auto g = States::arrow(States::State::Constant(0.2), end, Vector<double, 3>(0.6, 0, 0.8));
  Vector<J, G::dimension> a;
  Vector<J, G::dimension> b;
  for (int i = 0; i < G::dimension; ++i) {
    a(i) = J::variable(0, i);
    b(i) = J::variable(0, G::dimension + i);
  }
  const ArrowOf<G, J> whole = groupoid.translate(a, groupoid.cast<J>(g), b);
  const auto placed = [&](int source, int target) {
    return distance<G, J>(groupoid, displaced_jet<J>(groupoid, g, source, target), whole);
  };
  EXPECT_LT(placed(0, G::dimension), 1e-14);
  EXPECT_GT(placed(G::dimension, 0), 0.1);  // the ends exchanged
}

/// Its effort is not the integral of a running cost.
struct StepwiseCost : ControlledFlow<StepwiseCost, Pair<1>, 1> {
  template <class S> Vector<S, 1> flow(const Vector<S, 1>&, const Vector<S, 1>& u) const { return u; }
  template <class S> S running_cost(const Vector<S, 1>&, const Vector<S, 1>&) const { return S(1.0); }
  template <class S> S cost(const PairArrow<S, 1>&, const Vector<S, 1>& u, const S&) const { return u(0) * u(0); }
};

TEST(ControlledFlows, ACostThatIsWrittenAnewIsTheOneThatIsTaken) {
  const ControlTask<StepwiseCost> task{{}, {Vector<double, 1>(0.0), Vector<double, 1>(1.0)}, 2};
  const auto found = solve_control(task, 4);
  ASSERT_TRUE(found.report.converged()) << found.report.message;
  EXPECT_NEAR(found.report.cost, 4 * 0.25, 1e-9);  // u = 1/2 in each of four steps; the time would be 2
}

}  // namespace
}  // namespace lagroid::optimal_control_attitudes_tests
