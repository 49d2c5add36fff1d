// Bodies of several parts moved by torques between them, and the ball that rolls at a bounded speed.
#include "support.hpp"

#include <lagroid/systems/control/actuated/falling_cat.hpp>
#include <lagroid/systems/control/actuated/two_link_arm.hpp>
#include <lagroid/systems/control/flows/rolled_ball.hpp>
#include <lagroid/systems/control/plate_ball.hpp>

#include <numbers>
#include <vector>

namespace lagroid::optimal_control_arms_and_cats_tests {
namespace {

using control_tests::expect_laws;

template <class Sys> using StateOf = typename FlowStates<typename Sys::GroupoidType>::State;

/// Particles with the mass and the second moments of a half, about its centre.
std::vector<Vector<double, 3>> particles(const FallingCat& cat) {
  std::vector<Vector<double, 3>> out;  // each of mass / 6
  for (int i = 0; i < 3; ++i) {
    const double moment = 0.5 * cat.inertia.sum() - cat.inertia(i);
    const double distance = std::sqrt(3 * moment / cat.mass);
    out.emplace_back(distance * Vector<double, 3>::Unit(i));
    out.emplace_back(-distance * Vector<double, 3>::Unit(i));
  }
  return out;
}

// The action is that of particles which go straight from node to node, less that of the centre of mass.
TEST(FallingCats, MoveAsTheirParticles) {
  FallingCat cat;
  const Vector<double, 2> before(0.3, -0.7);
  const Vector<double, 2> after(0.5, -0.4);
  const Matrix<double, 3, 3> turn = SO3::exp(Vector<double, 3>(0.2, -0.3, 0.4));
  const Vector<double, 3> spine = Vector<double, 3>::UnitZ();
  std::vector<Vector<double, 3>> moves;
  for (const Vector<double, 3>& x : particles(cat)) {
    const Vector<double, 3> front = x - cat.reach * spine;
    moves.emplace_back(turn * front - front);
    const Vector<double, 3> rear = x + cat.reach * spine;
    moves.emplace_back(turn * FallingCat::bent(after) * rear - FallingCat::bent(before) * rear);
  }
  Vector<double, 3> mean = Vector<double, 3>::Zero();
  for (const auto& move : moves) mean += move / double(moves.size());
  double action = 0;
  for (const auto& move : moves) action += 0.5 * (cat.mass / 6) * (move - mean).squaredNorm() / cat.h;
  EXPECT_NEAR(cat.lagrangian(ArrowOf<FallingCat::GroupoidType>{turn, {before, after}}), action, 1e-13 * action);
  EXPECT_NEAR(FallingCat::bent(before).determinant(), 1, 1e-15);
}

ControlTask<BendingCat> half_a_turn() {
  StateOf<BendingCat> end = StateOf<BendingCat>::Zero();
  end(2) = std::numbers::pi / 2;
  ControlTask<BendingCat> task{{}, FlowStates<BendingCat::GroupoidType>::arrow(StateOf<BendingCat>::Zero(), end), 0.5};
  task.free_end = BendingCat::conserved;
  return task;
}

TEST(FallingCats, TurnWithoutAngularMomentum) {
  const auto task = half_a_turn();
  std::vector<double> costs;
  for (const long stages : {20L, 40L, 80L}) {
    const auto best = solve_control(task, control_guess(task, stages, 4));
    ASSERT_TRUE(best.report.converged()) << stages << ": " << best.report.message;
    costs.push_back(best.report.cost);
    double momentum = 0;
    double moved = 0;
    for (const auto& [arrow, momenta] : best.trajectory.arrows) {
      momentum = std::max(momentum, momenta.target.head<3>().cwiseAbs().maxCoeff());
      moved = std::max(moved, momenta.target.tail<2>().cwiseAbs().maxCoeff());
    }
    EXPECT_GT(moved, 1e-2);
    EXPECT_LE(momentum, 1e-14) << stages;
  }
  EXPECT_NEAR(std::log2((costs[0] - costs[1]) / (costs[1] - costs[2])), 2, 0.5);
}

TEST(FallingCats, NoStepHidesAHalfTurn) {
  const BendingCat cat;
  const auto broken = [&](double turn, double bend) {
    ArrowOf<BendingCat::GroupoidType> g;
    std::get<0>(std::get<0>(g)) = Eigen::AngleAxisd(turn, Eigen::Vector3d(1, 2, 2) / 3).toRotationMatrix();
    std::get<1>(std::get<0>(g)) = {Vector<double, 2>(0.1, 0.2), Vector<double, 2>(0.1 + bend, 0.2)};
    return cat.inequality(g, Vector<double, 2>(0, 0), 0.01).maxCoeff() > 0;
  };
  EXPECT_FALSE(broken(1.5, 0));
  EXPECT_TRUE(broken(1.6, 0));
  EXPECT_TRUE(broken(std::numbers::pi, 0));
  EXPECT_FALSE(broken(0.1, 1.3));
  EXPECT_TRUE(broken(0.1, 2 * std::numbers::pi));  // the same bend
}

// Energies by hand: arms along a line, both joints turning.
TEST(TwoLinkArms, HaveTheEnergyOfTheirLinks) {
  TwoLinkArm arm;
  arm.masses = {2, 3};
  arm.lengths = {0.7, 0.4};
  arm.gravity = 9.81;
  const Vector<double, 2> rate(0.8, -1.9);
  const Vector<double, 2> q(0.4, 0.9);
  const auto point = [&](double a, double b, int link, double s) {
    const Vector<double, 2> elbow = arm.lengths(0) * Vector<double, 2>(std::cos(a), std::sin(a));
    if (link == 0) return Vector<double, 2>(s * elbow);
    return Vector<double, 2>(elbow + s * arm.lengths(1) * Vector<double, 2>(std::cos(a + b), std::sin(a + b)));
  };
  double action = 0;
  const int pieces = 2000;
  const double small = 1e-5;
  for (int link = 0; link < 2; ++link)
    for (int i = 0; i < pieces; ++i) {
      const double s = (i + 0.5) / pieces;
      const Vector<double, 2> velocity = (point(q(0) + small * rate(0), q(1) + small * rate(1), link, s) -
                                          point(q(0) - small * rate(0), q(1) - small * rate(1), link, s)) /
                                         (2 * small);
      action +=
          arm.masses(link) / pieces * (0.5 * velocity.squaredNorm() - arm.gravity * point(q(0), q(1), link, s)(1));
    }
  const Vector<double, 2> half = rate * (0.5 * arm.h);
  const double of_step = arm.lagrangian(PairArrow<double, 2>{q - half, q + half});
  EXPECT_NEAR(of_step / arm.h, action, 1e-6 * std::abs(action));
}

TEST(TwoLinkArms, ReachRoundADisk) {
  ControlTask<PushedArm> task;
  // The elbow passes between the shoulder and the disk, at all times and not at nodes alone.
  task.system.system.disk_center = {1, 1};
  task.system.system.disk_radius = 0.3;
  task.duration = 2;
  task.boundary = FlowStates<PushedArm::GroupoidType>::arrow({0, 0.3, 0, 0}, {1.6, 0.3, 0, 0});
  expect_laws(task, 12);
  const auto found = search_control(task, 60, {.starts = 4});
  ASSERT_FALSE(found.minima.empty()) << found.best_failure.report.message;
  double nearest = 10;
  double between = 10;
  for (const auto& g : found.minima.front().trajectory.arrows) {
    nearest = std::min(nearest, -task.system.inequality(g, Vector<double, 2>(0, 0), 0.1).maxCoeff());
    for (double share = 0.1; share < 1; share += 0.1) {
      auto part = g;
      auto& [from, to] = std::get<0>(part);
      to = from + share * (to - from);
      between = std::min(between, -task.system.inequality(part, Vector<double, 2>(0, 0), 0.1).maxCoeff());
    }
  }
  EXPECT_GE(nearest, -1e-10);
  EXPECT_GE(between, -0.05);  // less of the radius than a thirtieth
  EXPECT_LE(nearest, 1e-6) << "the disk is not in the way";
  task.system.system.disk_radius = 0;
  const auto free = search_control(task, 60, {.starts = 2});
  ASSERT_FALSE(free.minima.empty());
  EXPECT_LT(free.minima.front().report.cost, 0.99 * found.minima.front().report.cost);
}

ControlTask<RolledBall> quarter_turn() {
  ControlTask<RolledBall> task;
  task.boundary = FlowStates<RolledBall::GroupoidType>::arrow(StateOf<RolledBall>::Zero(),
                                                              StateOf<RolledBall>(1, 0, 0, 0, std::numbers::pi / 2));
  task.duration = 4;
  return task;
}

// Without a bound it is the boundary value of PlateBall, of whose costs it makes twice as much.
TEST(RolledBalls, AreThePlateBallsWithoutABound) {
  auto task = quarter_turn();
  const long stages = 40;
  const auto found = search_control(task, stages, {.starts = 6});
  ASSERT_FALSE(found.minima.empty()) << found.best_failure.report.message;
  PlateBall ball;
  ball.rotation = SO3::retraction == Retraction::cayley ? RotationForm::cayley : RotationForm::exponential;
  ball.h = task.duration / double(stages);
  double cost = 0;
  for (const auto& g : found.minima.front().trajectory.arrows) {
    EXPECT_LE(ball.constraint(g).cwiseAbs().maxCoeff(), 1e-10);
    cost += 2 * ball.lagrangian(g);
  }
  EXPECT_NEAR(cost, found.minima.front().report.cost, 1e-10 * cost);
}

TEST(RolledBalls, KeepToASpeed) {
  auto task = quarter_turn();
  task.system.plate_rate = 0.5;  // on a plate at rest all speeds are equal
  expect_laws(task, 10);
  const auto free = search_control(task, 100, {.starts = 6});
  ASSERT_FALSE(free.minima.empty());
  double fastest = 0;
  for (const auto& u : free.minima.front().trajectory.controls) fastest = std::max(fastest, u.norm());
  task.system.largest_speed = 0.97 * fastest;
  const auto found = search_control(task, 100, {.starts = 6});
  ASSERT_FALSE(found.minima.empty()) << found.best_failure.report.message;
  long at_bound = 0;
  for (const auto& u : found.minima.front().trajectory.controls) {
    EXPECT_LE(u.norm(), task.system.largest_speed + 1e-9);
    if (u.norm() > task.system.largest_speed - 1e-9) ++at_bound;
  }
  EXPECT_GT(at_bound, 0);
  EXPECT_GT(found.minima.front().report.cost, free.minima.front().report.cost);
}

}  // namespace
}  // namespace lagroid::optimal_control_arms_and_cats_tests
