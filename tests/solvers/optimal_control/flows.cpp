// Derivatives of flows by the chain rule are those over jets along all directions of a stage.
#include "support.hpp"

#include <lagroid/systems/control/flows/double_integrator.hpp>
#include <lagroid/systems/control/flows/dubins_car.hpp>
#include <lagroid/systems/control/flows/hovercraft.hpp>
#include <lagroid/systems/control/flows/low_thrust.hpp>
#include <lagroid/systems/control/flows/planar_mass.hpp>
#include <lagroid/systems/control/flows/rolled_ball.hpp>
#include <lagroid/systems/control/flows/satellite_turn.hpp>
#include <lagroid/systems/control/flows/steered_car.hpp>
#include <lagroid/systems/control/flows/swing_up.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace lagroid::optimal_control_flows_tests {
namespace {

/// A flow of which the transcription knows cost and constraint alone.
template <class Flow>
struct ByJets
    : ControlSystem<ByJets<Flow>, typename Flow::GroupoidType, Flow::controls, Flow::equalities, Flow::inequalities> {
  Flow flow;
  template <class A, class V, class S> S cost(const A& g, const V& u, const S& h) const { return flow.cost(g, u, h); }
  template <class A, class V, class S> auto constraint(const A& g, const V& u, const S& h) const {
    return flow.constraint(g, u, h);
  }
  template <class A, class V, class S> auto inequality(const A& g, const V& u, const S& h) const {
    return flow.inequality(g, u, h);
  }
};

/// How far the two are apart, relative to the largest number, on a bent trajectory with multipliers drawn at random.
template <class Flow> double defect(const Flow& flow, const ArrowOf<typename Flow::GroupoidType>& boundary) {
  ControlTask<Flow> task{flow, boundary, 2, /*duration_is_free*/ true};
  ByJets<Flow> by_jets;
  by_jets.flow = flow;
  ControlTask<ByJets<Flow>> other{by_jets, boundary, 2, true};
  auto path = straight_trajectory(task, 5);
  std::mt19937_64 generator(2);
  std::normal_distribution<double> normal;
  for (auto& u : path.controls)
    for (double& x : u) x = normal(generator);
  TranscriptionOf<Flow> chained(task, path);
  TranscriptionOf<ByJets<Flow>> whole(other, {path.arrows, path.controls, path.phases});
  const TranscriptionSizes& sizes = chained.sizes();
  TrajectoryDisplacement bend(sizes);
  StageRows lambda(sizes.stages, sizes.equality);
  StageRows z(sizes.stages, sizes.inequality);
  for (StageRows* rows : {&bend.nodes, &lambda, &z})
    for (double& x : rows->numbers()) x = normal(generator);
  for (Transcription* each : {static_cast<Transcription*>(&chained), static_cast<Transcription*>(&whole)}) {
    each->try_displacement(bend, 0.3);
    each->accept();
  }
  StageDerivatives of_chained(sizes);
  StageDerivatives of_whole(sizes);
  chained.derivatives(lambda, z, of_chained);
  whole.derivatives(lambda, z, of_whole);
  double worst = 0;
  for (StageRows StageDerivatives::*part : {&StageDerivatives::gradient, &StageDerivatives::equality,
                                            &StageDerivatives::inequality, &StageDerivatives::hessian}) {
    StageRows difference = of_chained.*part;
    add(difference, -1, of_whole.*part);
    worst = std::max(worst, largest_entry(difference) / std::max(1.0, largest_entry(of_whole.*part)));
  }
  return worst;
}

template <class Flow> double defect(const Flow& flow) {
  using States = FlowStates<typename Flow::GroupoidType>;
  typename States::State start;
  typename States::State end;
  for (int i = 0; i < States::size; ++i) {
    start(i) = 0.1 * i;
    end(i) = 0.7 - 0.2 * i;
  }
  return defect(flow, States::arrow(start, end));
}

constexpr double rounding = 1e-12;

TEST(FlowDerivatives, AreThoseOverJetsAlongAllDirections) {
  DoubleIntegrator cart;
  cart.largest_speed = 1;
  EXPECT_LT(defect(cart), rounding);
  EXPECT_LT(defect(SwingUp()), rounding);
  EXPECT_LT(defect(DubinsCar()), rounding);
  EXPECT_LT(defect(Hovercraft()), rounding);
  EXPECT_LT(defect(SteeredCar()), rounding);
  RolledBall ball;
  ball.plate_rate = 0.7;
  ball.largest_speed = 2;
  EXPECT_LT(defect(ball), rounding);
}

/// Rates that depend on where the sun is: of an action, the object is read.
struct Sunlit : ControlledFlow<Sunlit, Product<Action<SO3, RotatedDirections>, Pair<1>>, 1> {
  template <class Q, class S> Vector<S, 4> flow(const Q& q, const Vector<S, 1>& u) const {
    const auto& [sun, rate] = q;
    Vector<S, 4> out;
    out << rate(0), u(0) * sun(1), sun(0) * sun(2), u(0) + sun(1) * rate(0);
    return out;
  }
  template <class Q, class S> S running_cost(const Q& q, const Vector<S, 1>& u) const {
    return u(0) * u(0) * std::get<0>(q)(2) + std::get<1>(q)(0);
  }
};

TEST(FlowDerivatives, OfAnActionWhoseObjectIsRead) {
  const Matrix<double, 3, 3> turn = SO3::exp(Vector<double, 3>(0.5, -0.2, 0.3));
  const Vector<double, 3> sun(0.6, 0.0, 0.8);
  EXPECT_LT(defect(Sunlit(), {{turn, sun}, {Vector<double, 1>(0.2), Vector<double, 1>(-0.4)}}), rounding);
}

/// Its derivatives leave out that controls and duration curve the cost together.
struct Careless : DubinsCar {
  template <class A, class V>
  void stage_derivatives(const A& g, const V& u, double h, const double* lambda, const StagePlaces& out) const {
    DubinsCar::stage_derivatives(g, u, h, lambda, out);
    out.hessian[6 * 8 + 7] = out.hessian[7 * 8 + 6] = 0;
  }
};

TEST(FlowDerivatives, LeftOutAreNoticed) { EXPECT_GT(defect(Careless()), 1e-3); }

/// Its inequality is of where the arrow begins, whatever it says.
struct Misread : DoubleIntegrator {
  template <class S> Vector<S, 2> inequality(const PairArrow<S, 2>& g, const Vector<S, 1>&, const S&) const {
    return {g.source(1) - largest_speed, -g.source(1) - largest_speed};
  }
};

TEST(FlowDerivatives, OfInequalitiesThatAreNotOfTheEndAreNoticed) {
  Misread cart;
  cart.largest_speed = 1;
  EXPECT_GT(defect(cart), 1e-3);
}

TEST(FlowDerivatives, OfAMassBesideADisk) {
  PlanarMass mass;
  mass.disk_radius = 0.5;
  mass.largest_force = 2;
  EXPECT_LT(defect(mass), rounding);
}

TEST(FlowDerivatives, OfACostByWeights) {
  PlanarMass mass;
  mass.weights = {{2, 0.3}, 0.7};
  EXPECT_LT(defect(mass), rounding);
}

TEST(FlowDerivatives, OfASatelliteBesideACone) {
  SatelliteTurn satellite;
  satellite.cone = 0.4;
  using States = FlowStates<SatelliteTurn::GroupoidType>;
  States::State start;
  start << 0.1, 0.4, -0.2, 0.3, 0.1, -0.2;
  States::State end;
  end << 0.8, -0.3, 0.5, -0.1, 0.2, 0.4;
  EXPECT_LT(defect(satellite, States::arrow(start, end, satellite.avoided)), rounding);
}

// The pull bends sharply there: differences of one width would be off by more than is allowed.
TEST(FlowDerivatives, AreThoseOfValuesBesideACenterOfAttraction) {
  const ControlTask<LowThrust> task{{}, {{1, 0, 0, 1}, {-1, 0.08, 0, -1}}, 3};
  TranscriptionOf<LowThrust> past(task, straight_trajectory(task, 41));
  const laws::LawReport report = laws::transcription_laws(past, 5);
  EXPECT_TRUE(report.holds()) << report;
}

}  // namespace
}  // namespace lagroid::optimal_control_flows_tests
