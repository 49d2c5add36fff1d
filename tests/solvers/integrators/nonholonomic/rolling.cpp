// Balls and disks that roll: circles, order, and reactions that do no work.
#include "../../../support/broken.hpp"
#include "../../../support/draws.hpp"
#include "../../../support/integrating.hpp"
#include "../../../support/turning_plate.hpp"

#include <lagroid/solvers/testing/dalembert_laws.hpp>
#include <lagroid/systems/rolling/rolling_disk.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

using namespace lagroid;

namespace nonholonomic_rolling_tests {
namespace {

static_assert(Nonholonomic<RollingBall> && !Variational<RollingBall> && !Forced<RollingBall>);
static_assert(HasAnnihilator<RollingBall>);

/// The reaction turns the ball the wrong way round.
struct WrongReaction : RollingBall {
  Matrix<double, 5, 2> annihilator(const ObjectOf<Plane>& q) const {
    Matrix<double, 5, 2> omega = RollingBall::annihilator(q);
    omega.bottomRows<3>() *= -1;
    return omega;
  }
  Step<WrongReaction> first_guess(const State<Plane>& s) const { return {RollingBall::first_guess(s).arrow, {0, 0}}; }
};

/// The centre c of the continuous circle: velocity i rate (z - c) at z.
std::complex<double> centre_of_circle(const RollingBall& ball, const State<Plane>& s) {
  const double rate = ball.plate_rate * ball.inertia_factor / (1 + ball.inertia_factor);
  const std::complex<double> v(s.momentum(0) / ball.mass, s.momentum(1) / ball.mass);
  return position_of(s) - v / std::complex<double>(0, rate);
}

TEST(RollingBall, ReferenceGoesRoundACircleAtTwoSeventhsOfThePlatesRate) {
  const RollingBall ball = ball_on_turning_plate();
  const auto start = start_of(ball);
  const auto c = centre_of_circle(ball, start);
  Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  const double t = 5;
  const auto end = ball.reference(start, attitude, t);
  const auto exact = c + (position_of(start) - c) * std::polar(1.0, 2.0 / 7 * ball.plate_rate * t);
  EXPECT_LT(std::abs(position_of(end) - exact), 1e-12);
  EXPECT_NEAR(ball.moving_energy(end), ball.moving_energy(start), 1e-12);
}

TEST(RollingBall, CentreGoesRoundThatCircleAtARateOfOrderTwo) {
  for (const double k : {2.0 / 5, 2.0 / 3}) {
    RollingBall ball = ball_on_turning_plate();
    ball.inertia_factor = k;
    const auto start = start_of(ball);
    const auto c = centre_of_circle(ball, start);
    const double rate = ball.plate_rate * k / (1 + k);
    std::vector<double> errors;
    for (const double h : {0.1, 0.05, 0.025}) {
      ball.h = h;
      const long steps = std::lround(4 / h);  // less than half a turn
      const auto end = integrate(ball, start, steps);
      const auto turned = (position_of(end.state) - c) / (position_of(start) - c);
      EXPECT_NEAR(std::abs(turned), 1, 1e-13);
      const double measured = std::arg(turned) / (double(steps) * h);
      EXPECT_NEAR(measured, 2 / h * std::atan(h * rate / 2), 1e-13);
      errors.push_back(std::abs(measured - rate));
    }
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(std::log2(errors[i] / errors[i + 1]), 2, 0.01);
  }
}

TEST(RollingBall, OrderTwoInAllThatIsReported) {
  const RollingBall ball = ball_on_turning_plate();
  const auto start = start_of(ball);
  Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  const auto exact = ball.reference(start, attitude, 5.0);
  using Point = TrajectoryPoint<RollingBall>;
  const auto order = [&](const auto& error) {
    return measured_order(ball, start, 5.0, 50, [&](const RollingBall& s, const Point& p) { return error(s, p); });
  };
  EXPECT_NEAR(order([&](const auto&, const Point& p) { return std::abs(position_of(p.state) - position_of(exact)); }),
              2, 0.02);
  EXPECT_NEAR(order([&](const auto&, const Point& p) { return (std::get<1>(p.configuration) - attitude).norm(); }), 2,
              0.02);
  EXPECT_NEAR(order([&](const auto& s, const Point& p) { return (reported_momentum(s, p) - exact.momentum).norm(); }),
              2, 0.02);
  // As it leaves the arrow the momentum lacks half a reaction.
  EXPECT_NEAR(order([&](const auto&, const Point& p) { return (p.state.momentum - exact.momentum).norm(); }), 1, 0.05);
}

TEST(RollingBall, PlateAtRestKeepsTheBallOnAStraightLine) {
  const RollingBall ball;
  const auto start = start_of(ball);
  const auto end = integrate(ball, start, 100);
  const std::complex<double> v(start.momentum(0), start.momentum(1));
  EXPECT_LT(std::abs(position_of(end.state) - position_of(start) - v * (100 * ball.h)), 1e-12);
  EXPECT_NEAR(ball.energy(end.state), ball.energy(start), 1e-14);
}

TEST(BrokenReaction, ThatTurnsTheBallTheWrongWay) {
  WrongReaction ball;
  ball.plate_rate = 1.3;
  const auto start = start_of(ball);
  const auto end = integrate(ball, start, 60);
  const double drift = ball.moving_energy({end.state.object, reported_momentum(ball, end)}) - ball.moving_energy(start);
  EXPECT_GT(std::abs(drift), 1e-2);
  const auto report = laws::dalembert_laws(ball, [&] { return start; });
  EXPECT_TRUE(laws::seen_broken(report.law("the distribution is that of the constraints"))) << report;
}

TEST(RollingDisk, RatesAndEnergyAreConstantAndTheCircleIsOfOrderTwo) {
  RollingDisk disk;
  disk.radius = 0.7;
  const auto start = disk.rolling(0.6, 1.1);
  auto integrator = integrator_from(disk, start);
  for (int k = 0; k < 200; ++k) {
    ASSERT_TRUE(integrator.advance().converged());
    const auto momentum = reported_momentum(disk, integrator.point());
    EXPECT_LT((momentum - start.momentum).norm(), 1e-14);
    EXPECT_NEAR(disk.energy({start.object, momentum}), disk.energy(start), 1e-14);
  }
  ArrowOf<RollingDisk::GroupoidType> exact = disk.groupoid.unit(start.object);
  disk.reference(start, exact, 5.0);
  const double order =
      measured_order(disk, start, 5.0, 50, [&](const RollingDisk&, const TrajectoryPoint<RollingDisk>& end) {
        return (std::get<0>(end.configuration) - std::get<0>(exact)).norm() +
               (std::get<1>(end.configuration) - std::get<1>(exact)).norm();
      });
  EXPECT_NEAR(order, 2, 0.02);
}

// Where a section leaves L as it is, its momentum is.
TEST(MomentumEquation, MomentaOfSymmetriesStayOnATurningPlate) {
  const RollingBall ball = ball_on_turning_plate();
  for (const auto& symmetry : ball.symmetries()) {
    EXPECT_LT(laws::detail::drift(ball, symmetry.quantity(), start_of(ball), 300), 1e-13) << symmetry.name;
    EXPECT_LT(laws::detail::drift(ball, momentum_balance(ball, symmetry), start_of(ball), 300), 1e-13) << symmetry.name;
  }
}

TEST(Annihilator, OfAnAffineConstraintHoldsNothingOfTheAffineTerm) {
  const RollingBall ball = ball_on_turning_plate();
  const auto start = start_of(ball);
  EXPECT_LT((deduced_annihilator(ball, start.object) - ball.annihilator(start.object)).norm(), 1e-15);
  // The derivative at one end does: the plate turns under the midpoint.
  const auto d = automatic_two_sided(ball, ball.groupoid.unit(start.object), RollingBall::Multipliers::Zero().eval());
  EXPECT_GT((d.constraint_target.transpose() - ball.annihilator(start.object)).norm(), 0.5 * ball.h * ball.plate_rate);
}

TEST(Nonholonomic, NoVirtualWorkWhereBallsAndDisksRoll) {
  const RollingBall ball = ball_on_turning_plate();
  const auto on_plate = laws::dalembert_laws(
      ball, [&] { return ball.rolling(laws::draw_vector<2>(1.0), laws::draw_vector<2>(1.0), laws::draw_uniform()); });
  EXPECT_TRUE(on_plate.holds()) << on_plate;
  const RollingDisk disk;
  const auto rolling =
      laws::dalembert_laws(disk, [&] { return disk.rolling(laws::draw_uniform(), 1.5 + laws::draw_uniform()); });
  EXPECT_TRUE(rolling.holds()) << rolling;
}

TEST(Nonholonomic, MomentumChangeIsFplusLessFminus) {
  const RollingBall ball = ball_on_turning_plate();
  const auto point = integrate(ball, start_of(ball), 3);
  const auto d = gradients(ball, point.step.arrow, point.step.multipliers);
  const Vector<double, 5> difference = d.source_gradient + d.target_gradient;
  EXPECT_LT((momentum_change(ball, point.step, d) - difference).norm(), 1e-13);
  // The groupoid's own form takes the arrow to be variational.
  const Vector<double, 5> variational =
      ball.groupoid.momentum_change(point.step.arrow, d.source_gradient, d.target_gradient);
  EXPECT_GT((variational - difference).norm(), 1e-3);
}

}  // namespace
}  // namespace nonholonomic_rolling_tests
