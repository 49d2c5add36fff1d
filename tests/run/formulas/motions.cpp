// Lagrangians that are texts: their steps are those of the same Lagrangian in C++, constraints and forces included.
#include <lagroid/run/formula/formula_lagrangian.hpp>
#include <lagroid/run/formula/formula_motion.hpp>
#include <lagroid/solvers/galerkin/curve_step.hpp>
#include <lagroid/solvers/galerkin/galerkin.hpp>
#include <lagroid/solvers/galerkin/rules_of_order_two.hpp>
#include <lagroid/systems/reference.hpp>

#include "../../solvers/continuous_lagrangian/subjects.hpp"
#include "../../support/allocation_counter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

using namespace lagroid;
using namespace lagroid::subjects;

namespace formulas_motions_tests {
namespace {

/// The texts of a scene.
struct Written {
  FormulaTexts texts;
  std::string l;
  std::vector<std::string> force = {};
};
FormulaMotion motion_of(const Written& written, const CurveChoice& curve, const Eigen::VectorXd& q,
                        const Eigen::VectorXd& p, double h) {
  auto system = std::make_unique<FormulaLagrangian>(written.texts, written.l, written.force);
  FormulaMethod method{std::make_unique<CurveStep>(*system, curve), {"curve", curve.order(), true, true, false}};
  return {"formula", std::move(system), std::move(method), {q, p}, h, 0};
}
std::vector<double> ends(FormulaMotion& motion, int steps) {
  for (int k = 0; k < steps; ++k) EXPECT_TRUE(motion.advance().converged()) << k;
  const auto state = motion.state();
  std::vector<double> all = state[0].values;
  all.insert(all.end(), state[1].values.begin(), state[1].values.end());
  return all;
}

const Written orbit{{.coordinates = {"x", "y"}, .symmetries = {{"angular momentum", {"-y", "x"}}}},
                    "(x'^2 + y'^2)/2 + 1/sqrt(x^2 + y^2)"};
const Written bead{{.coordinates = {"x", "y", "z"}, .constraints = {"(x^2 + y^2 + z^2 - 1)/2"}},
                   "(x'^2 + y'^2 + z'^2)/2 - z"};

template <class Sys>
void expect_steps_of(const Sys& system, const Written& texts, const CurveChoice& curve,
                     const State<typename Sys::GroupoidType>& start, int steps) {
  auto run = make(system, start);
  for (int k = 0; k < steps; ++k) ASSERT_TRUE(run.advance().converged()) << k;
  FormulaMotion motion = motion_of(texts, curve, start.object, start.momentum, system.h);
  const std::vector<double> found = ends(motion, steps);
  State<typename Sys::GroupoidType> end = run.point().state;
  constexpr int n = Sys::dimension;
  if constexpr (Sys::object_constraints > 0)  // of the unit sphere
    end.momentum -= end.object * end.object.dot(end.momentum) / end.object.squaredNorm();
  for (int i = 0; i < n; ++i) {
    EXPECT_NEAR(found[std::size_t(i)], end.object(i), 1e-12) << Sys::traits().name;
    EXPECT_NEAR(found[std::size_t(n + i)], end.momentum(i), 1e-12) << Sys::traits().name;
  }
}

TEST(FormulaMotions, StepsAreThoseOfTheSameLagrangianInCpp) {
  const State<Pair<2>> start{{1, 0.1}, {0.1, 1.1}};
  expect_steps_of(Midpoint<Orbit>{{}, 0.05}, orbit, {CurveQuadrature::gauss, 1}, start, 50);
  expect_steps_of(Trapezoidal<Orbit>{{}, 0.05}, orbit, {CurveQuadrature::lobatto, 1}, start, 50);
  expect_steps_of(Galerkin<Orbit, 2>{{}, 0.1}, orbit, {CurveQuadrature::gauss, 2}, start, 30);
  expect_steps_of(Galerkin<Orbit, 3>{{}, 0.1}, orbit, {CurveQuadrature::gauss, 3}, start, 30);
}
TEST(FormulaMotions, WithConstraints) {
  expect_steps_of(Trapezoidal<Bead>{{}, 0.05}, bead, {CurveQuadrature::lobatto, 1}, bead_start, 50);
  expect_steps_of(Galerkin<Bead, 3, CurveQuadrature::lobatto_pair>{{}, 0.1}, bead, {CurveQuadrature::lobatto_pair, 3},
                  bead_start, 30);
}

/// The order in the end of a motion whose exact end is known.
void expect_order(const Written& texts, const CurveChoice& curve, const Eigen::VectorXd& q, const Eigen::VectorXd& p,
                  double horizon, const Eigen::VectorXd& exact, int coarsest, double tolerance = 0.1) {
  laws::OrderProblem problem;
  problem.exact = exact;
  problem.coarsest = coarsest;
  problem.end = [&](int steps) {
    FormulaMotion motion = motion_of(texts, curve, q, p, horizon / steps);
    const std::vector<double> end = ends(motion, steps);
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(end.data(), Eigen::Index(exact.size())));
  };
  MethodTraits traits;
  traits.name = "a curve of degree " + std::to_string(curve.degree);
  traits.order = curve.order();
  EXPECT_TRUE(laws::order_laws(traits, problem, tolerance).holds()) << laws::measured_order(problem);
}

// x'' = x - x^3 + 0.3 cos(1.2 t) - 0.15 x', which knows the time and is damped.
TEST(FormulaMotions, OrdersWithForcesAndTime) {
  const Written duffing{
      {.coordinates = {"x"}, .parameters = {{"m", 1.0}}}, "m*x'^2/2 + x^2/2 - x^4/4 + 0.3*x*cos(1.2*t)", {"-0.15*x'"}};
  const auto rates = [](const Eigen::VectorXd& y, Eigen::VectorXd& dy) {
    dy << y(1), y(0) - y(0) * y(0) * y(0) + 0.3 * std::cos(1.2 * y(2)) - 0.15 * y(1), 1;
  };
  Eigen::VectorXd start(3);
  start << 1, 0, 0;
  const Eigen::VectorXd end = integrate_reference(rates, start, 4.0).head(2);
  const Eigen::VectorXd q = Eigen::VectorXd::Constant(1, 1.0), p = Eigen::VectorXd::Zero(1);
  expect_order(duffing, {CurveQuadrature::gauss, 1}, q, p, 4, end, 30);
  expect_order(duffing, {CurveQuadrature::lobatto, 1}, q, p, 4, end, 30);
  expect_order(duffing, {CurveQuadrature::gauss, 2}, q, p, 4, end, 10);
  expect_order(duffing, {CurveQuadrature::gauss, 3}, q, p, 4, end, 8);
  expect_order(duffing, {CurveQuadrature::lobatto, 2}, q, p, 4, end, 10);
}
TEST(FormulaMotions, OrdersOnASphere) {
  const Eigen::VectorXd end = bead_end(4);
  const Eigen::VectorXd q = bead_start.object, p = bead_start.momentum;
  expect_order(bead, {CurveQuadrature::lobatto_pair, 2}, q, p, 4, end, 30);
  expect_order(bead, {CurveQuadrature::lobatto_pair, 3}, q, p, 4, end, 12);
  expect_order(bead, {CurveQuadrature::lobatto_pair, 4}, q, p, 4, end, 10);
  expect_order(bead, {CurveQuadrature::lobatto_pair, 5}, q, p, 4, end, 6, 0.3);
}

TEST(FormulaMotions, KeepMomentaAndTheirEnergyWithinABand) {
  FormulaMotion motion =
      motion_of(orbit, {CurveQuadrature::gauss, 2}, Eigen::Vector2d(1, 0), Eigen::Vector2d(0.1, 1.1), 0.1);
  double momentum, energy, first_energy;
  motion.look().measure(0, &first_energy);
  for (int k = 0; k < 2000; ++k) {
    ASSERT_TRUE(motion.advance().converged());
    const Observables& at = motion.look();
    at.measure(1, &momentum);
    at.measure(0, &energy);
    EXPECT_NEAR(momentum, 1.1, 1e-12);
    EXPECT_NEAR(energy, first_energy, 1e-4);
  }
}

// An l that is not convex: two velocities have one momentum, and the start says which.
TEST(FormulaMotions, GoOnWithTheVelocityTheyBeganWith) {
  const Written double_well{{.coordinates = {"x"}}, "x'^4/4 - x'^2/2"};
  for (const double v : {1.1, 1.5, -1.2}) {
    auto system = std::make_unique<FormulaLagrangian>(double_well.texts, double_well.l);
    FormulaMethod method{std::make_unique<CurveStep>(*system, CurveChoice{}), {}};
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(1);
    FormulaMotion motion("free", std::move(system), std::move(method),
                         {zero, Eigen::VectorXd::Constant(1, v * v * v - v), Eigen::VectorXd::Constant(1, v)}, 0.1, 0);
    for (int k = 0; k < 10; ++k) ASSERT_TRUE(motion.advance().converged());
    EXPECT_NEAR(motion.state()[0].values[0], v, 1e-12);
  }
}

// The parts of a momentum that is zero cancel: the rounding of its equation is that of the parts.
TEST(FormulaMotions, OfACartThatNothingPushes) {
  const Written cart{{.coordinates = {"x", "theta"}},
                     "(3*x'^2 + 2*0.8*x'*theta'*cos(theta) + 0.64*theta'^2)/2 + 9.81*0.8*cos(theta)"};
  for (const CurveChoice& curve : {CurveChoice{}, CurveChoice{.degree = 2}, CurveChoice{.degree = 3}}) {
    FormulaMotion motion = motion_of(cart, curve, Eigen::Vector2d(0, 2), Eigen::Vector2d::Zero(), 0.01);
    const std::vector<double> end = ends(motion, 2000);
    EXPECT_NEAR(end[2], 0, 1e-13);
  }
}

// What is kept is all that the next step depends on; parts of steps are looked into without a trace.
TEST(FormulaMotions, GoOnWithTheSameBits) {
  FormulaMotion one = motion_of(bead, {CurveQuadrature::lobatto_pair, 3}, bead_start.object, bead_start.momentum, 0.1);
  FormulaMotion other =
      motion_of(bead, {CurveQuadrature::lobatto_pair, 3}, bead_start.object, bead_start.momentum, 0.1);
  ends(one, 10);
  NumberArchive kept;
  one.serialize(kept);
  NumberArchive read(kept.numbers());
  other.serialize(read);
  for (int k = 0; k < 10; ++k) {
    one.keep_node();
    ASSERT_TRUE(one.advance().converged());
    ASSERT_NE(one.look_within(0.3), nullptr);
    ASSERT_TRUE(other.advance().converged());
  }
  EXPECT_EQ(one.state()[0].values, other.state()[0].values);
  EXPECT_EQ(one.state()[1].values, other.state()[1].values);
}

// x'' = -k x with another k from inside of a step on: the exact motion to that time, and from there that of the other.
TEST(FormulaMotions, GoOnWithOtherParameters) {
  const Written spring{{.coordinates = {"x"}, .parameters = {{"k", 1.0}}}, "x'^2/2 - k*x^2/2"};
  const auto one = Eigen::VectorXd::Constant(1, 1.0);
  FormulaMotion motion = motion_of(spring, {CurveQuadrature::gauss, 5}, one, Eigen::VectorXd::Zero(1), 0.1);
  ends(motion, 10);
  motion.keep_node();
  ASSERT_TRUE(motion.advance().converged());
  const MotionChange change{.parameters = {{"k", 4.0}}};
  EXPECT_EQ(motion.refused(0.3, change), "");
  ASSERT_TRUE(motion.change_within(0.3, change).converged());
  NumberArchive kept;
  motion.serialize(kept);
  FormulaMotion resumed = motion_of(spring, {CurveQuadrature::gauss, 5}, one, Eigen::VectorXd::Zero(1), 0.1);
  NumberArchive read(kept.numbers());
  resumed.serialize(read);
  const double at = 1.03, then = 2.1 - at;
  const double x = std::cos(at) * std::cos(2 * then) - std::sin(at) * std::sin(2 * then) / 2;
  EXPECT_NEAR(ends(motion, 10)[0], x, 1e-12);
  EXPECT_EQ(ends(resumed, 10)[0], motion.state()[0].values[0]);
  EXPECT_NE(motion.refused(0.3, {.parameters = {{"k", NAN}}}), "");
}
TEST(FormulaMotions, DoNotLeaveTheirConstraintsByOtherParameters) {
  const Written wheel{{.coordinates = {"x", "y"}, .constraints = {"x^2 + y^2 - r^2"}, .parameters = {{"r", 1.0}}},
                      "(x'^2 + y'^2)/2"};
  FormulaMotion motion =
      motion_of(wheel, {CurveQuadrature::lobatto, 1}, Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1), 0.1);
  motion.keep_node();
  ASSERT_TRUE(motion.advance().converged());
  EXPECT_EQ(motion.refused(0.5, {.parameters = {{"r", 1.0}}}), "");
  EXPECT_NE(motion.refused(0.5, {.parameters = {{"r", 1.1}}}), "");
  // Turned where it is met, a line takes away what goes across it; near zero rounding is that of the step.
  const Written line{{.coordinates = {"x", "y"}, .constraints = {"y - a*x"}, .parameters = {{"a", 0.0}}},
                     "(x'^2 + y'^2)/2"};
  FormulaMotion turned =
      motion_of(line, {CurveQuadrature::lobatto, 1}, Eigen::Vector2d(-0.05, 0), Eigen::Vector2d(1, 0), 0.1);
  turned.keep_node();
  ASSERT_TRUE(turned.advance().converged());
  EXPECT_EQ(turned.refused(0.5, {.parameters = {{"a", 0.0}}}), "");
  EXPECT_NE(turned.refused(0.5, {.parameters = {{"a", 1.0}}}).find("velocity leaves constraint 1"), std::string::npos);
}
TEST(FormulaMotions, DoNotLoseTheirSymmetriesByOtherParameters) {
  const Written orbit_of{{.coordinates = {"x", "y"}, .symmetries = {{"turn", {"-y", "x"}}}, .parameters = {{"k", 1.0}}},
                         "(x'^2 + y'^2)/2 - (k*x^2 + y^2)/2"};
  FormulaMotion motion =
      motion_of(orbit_of, {CurveQuadrature::gauss, 1}, Eigen::Vector2d(1, 0.2), Eigen::Vector2d(0, 1), 0.1);
  motion.keep_node();
  ASSERT_TRUE(motion.advance().converged());
  EXPECT_EQ(motion.refused(0.5, {.parameters = {{"k", 1.0}}}), "");
  EXPECT_NE(motion.refused(0.5, {.parameters = {{"k", 4.0}}}).find("\"turn\" is no symmetry"), std::string::npos);
}

TEST(FormulaMotions, StepsAllocateNothing) {
  FormulaMotion motion =
      motion_of(bead, {CurveQuadrature::lobatto_pair, 3}, bead_start.object, bead_start.momentum, 0.1);
  ends(motion, 3);
  const long before = allocation_count();
  if (before < 0) GTEST_SKIP() << "allocations are not counted here";
  for (int k = 0; k < 50; ++k) motion.advance();
  EXPECT_EQ(allocation_count(), before);
}

TEST(FormulaMotions, AStepThatFailsIsNotTaken) {
  // y' does not occur.
  const Written degenerate{{.coordinates = {"x", "y"}}, "x'^2/2 - x^2/2 - y^2"};
  FormulaMotion motion = motion_of(degenerate, {}, Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 0), 0.1);
  EXPECT_EQ(motion.advance().status, SolveStatus::singular);
  EXPECT_EQ(motion.index(), 0);
  FormulaMotion beyond = motion_of({{.coordinates = {"x"}}, "x'^2/2 + ln(x)"}, {}, Eigen::VectorXd::Constant(1, -1.0),
                                   Eigen::VectorXd::Zero(1), 0.1);
  EXPECT_EQ(beyond.advance().status, SolveStatus::not_finite);
  EXPECT_THROW(motion_of(bead, {CurveQuadrature::gauss, 2}, Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, 0), 0.1),
               std::invalid_argument);
}

TEST(FormulaLagrangians, SayWhatIsWrongWithTheirTexts) {
  const auto key_of = [](const Written& written) -> std::string {
    try {
      const FormulaLagrangian read(written.texts, written.l, written.force);
    } catch (const FormulaError& error) {
      return error.key();
    }
    return "";
  };
  EXPECT_EQ(key_of(orbit), "");
  EXPECT_EQ(key_of({{.coordinates = {"x", "x"}}, "x'^2"}), "coordinates");
  EXPECT_EQ(key_of({{.coordinates = {"t"}}, "t'^2"}), "coordinates");
  EXPECT_EQ(key_of({{.coordinates = {"2x"}}, "1"}), "coordinates");
  EXPECT_EQ(key_of({{.coordinates = {"sin"}}, "1"}), "coordinates");
  EXPECT_EQ(key_of({{.coordinates = {"energy"}}, "1"}), "coordinates");
  EXPECT_EQ(key_of({{.coordinates = {"x", "p_x"}}, "1"}), "coordinates");
  EXPECT_EQ(key_of({{.coordinates = {"x"}}, "x'^2 + 0/0*x"}), "l");
  EXPECT_EQ(key_of({{.coordinates = {"x"}}, "x'^2 - (-8)^(1/3)*x^2"}), "l");
  EXPECT_EQ(key_of({{.coordinates = {"x"}}, "x'^2 + column_0_"}), "l");
  EXPECT_EQ(key_of({{.coordinates = {"x"}, .symmetries = {{"J", {"1"}}, {"J", {"1"}}}}, "x'^2"}), "name");
  EXPECT_EQ(key_of({{.coordinates = {"x"}, .symmetries = {{"energy", {"1"}}}}, "x'^2"}), "name");
  EXPECT_EQ(key_of({{}, "1"}), "coordinates");
  EXPECT_EQ(key_of({{.coordinates = {"x"}}, "y'^2"}), "l");
  EXPECT_EQ(key_of({{.coordinates = {"x"}, .constraints = {"x"}}, "x'^2"}), "constraints");
  EXPECT_EQ(key_of({{.coordinates = {"x", "y"}, .constraints = {"x'"}}, "x'^2"}), "constraints");
  EXPECT_EQ(key_of({{.coordinates = {"x", "y"}}, "x'^2", {"x"}}), "force");
  EXPECT_EQ(key_of({{.coordinates = {"x"}, .symmetries = {{"J", {"t"}}}}, "x'^2"}), "field");
  EXPECT_EQ(key_of({{.coordinates = {"x"}, .parameters = {{"x", 1.0}}}, "x'^2"}), "parameters");
  EXPECT_EQ(key_of({{.coordinates = {"x"}, .parameters = {{"unused", 1.0}}}, "x'^2"}), "parameters");
}

TEST(FormulaLagrangians, KnowWhichFieldsAreSymmetries) {
  const FormulaLagrangian read(orbit.texts, orbit.l);
  const double q[] = {0.3, 0.9}, v[] = {-0.2, 0.7};
  EXPECT_LT(read.symmetry_defect(0, 0, q, v), 1e-15);
  EXPECT_TRUE(read.symmetries()[0].affine);
  FormulaTexts none = orbit.texts;
  none.symmetries = {{"no momentum", {"1", "0"}}, {"none either", {"x^2", "y"}}};
  const FormulaLagrangian other(none, orbit.l);
  EXPECT_GT(other.symmetry_defect(0, 0, q, v), 1e-3);
  EXPECT_GT(other.symmetry_defect(1, 0, q, v), 1e-3);
  EXPECT_FALSE(other.symmetries()[1].affine);
}

}  // namespace
}  // namespace formulas_motions_tests
