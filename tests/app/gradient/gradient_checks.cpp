// What tables of derivatives say of themselves: what differences contradict and cannot tell, the growth of errors,
// numbers that are none; and directions, of which scenes give numbers of any length.
#include "subject_of_run.hpp"

#include <gradient/columns/computed_columns.hpp>
#include <gradient/columns/given_directions.hpp>
#include <gradient/gradient_table.hpp>

#include <lagroid/core/parameter.hpp>
#include <lagroid/solvers/sensitivity/sensitivities.hpp>
#include <lagroid/systems/mechanical.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace lagroid::app::gradient_checks_tests {
namespace {

using Names = std::vector<std::string>;

/// A bob in a valley along the line across n.
struct Valley : MechanicalSystem<Valley, 2> {
  double stiffness = 3;
  Vector<double, 2> across{0.6, 0.8};
  static double mass() { return 1; }
  template <class S> S potential(const Vector<S, 2>& q) const {
    const auto& n = varied<S>(across);
    const S depth = q(0) * n(0) + q(1) * n(1);
    return cos(depth) * (varied<S>(stiffness) * -1.0) + q.squaredNorm() * 0.5;
  }
  static auto parameters() {
    return std::tuple(parameter("stiffness", &Valley::stiffness, "N", "of the valley", positive),
                      direction("across", &Valley::across, "in which it is steep"));
  }
};

GradientSubject subject_of(const Valley& given, long steps = 40) {
  Valley valley = given;
  valley.h = 0.1;
  return subject_of_run<2>("valley", valley, {{0.5, 0.3}, {0.1, -0.2}}, steps,
                           {{"position", "x"}, {"position", "y"}, {"momentum", "px"}, {"momentum", "py"}});
}

/// Runs beside this one start too far away by so much: every derivative is wrong.
GradientSubject exaggerated(const GradientSubject& subject, double factor) {
  GradientSubject out = subject;
  out.begin = [=, begin = subject.begin](const Names& parameters, std::vector<Nudge> nudges) {
    for (Nudge& each : nudges) each.by *= factor;
    return begin(parameters, nudges);
  };
  return out;
}

const Names all{"initial", "parameters"};

TEST(GradientChecks, DifferencesContradictWrongDerivativesAndNoOthers) {
  const GradientSubject subject = subject_of(Valley());
  const GradientTable right = differentiate(subject, {"final"}, all, /*check=*/true);
  EXPECT_EQ(right.contradicted, Names{});
  EXPECT_EQ(right.untold, Names{});
  EXPECT_GT(right.digits_agreed, 8);
  for (const double factor : {1.001, -1.0, 1e4, 1e-4, 0.0}) {
    const GradientTable wrong = differentiate(exaggerated(subject, factor), {"final"}, all, /*check=*/true);
    EXPECT_GT(wrong.contradicted.size(), 14u) << factor;
    EXPECT_LT(wrong.digits_agreed, 3.5) << factor;
    EXPECT_NE(text_of(wrong).find("they contradict"), std::string::npos);
    EXPECT_NE(json_of(wrong).find("\"final.x by initial.y\""), std::string::npos);
  }
}

TEST(GradientChecks, WhereValuesJumpDifferencesCannotTell) {
  // The values of runs beside each other are those of no smooth function, by more than they differ.
  const GradientSubject subject = subject_of(Valley());
  GradientSubject jumping = subject;
  jumping.begin = [begin = subject.begin](const Names& parameters, std::vector<Nudge> nudges) {
    for (Nudge& each : nudges) each.by += each.by > 0 ? 0.3 : -0.1;
    return begin(parameters, nudges);
  };
  const GradientTable found = differentiate(jumping, {"final"}, {"initial"}, /*check=*/true);
  EXPECT_EQ(found.contradicted, Names{});
  EXPECT_GT(found.untold.size(), 10u);
  EXPECT_NE(text_of(found).find("cannot tell"), std::string::npos);
}

TEST(GradientChecks, RunsByATolerancePromiseNoMoreThanItLets) {
  // Inner steps of their own change runs by as much as the tolerance lets them, and derivatives with these.
  const GradientSubject subject = subject_of(Valley());
  for (const double tolerance : {1e-3, 1e-4}) {
    GradientSubject loose = exaggerated(subject, 1 + tolerance);
    EXPECT_NE(differentiate(loose, {"final"}, all, /*check=*/true).contradicted, Names{}) << tolerance;
    loose.tolerance = tolerance;
    const GradientTable found = differentiate(loose, {"final"}, all, /*check=*/true);
    EXPECT_EQ(found.contradicted, Names{}) << tolerance;
    EXPECT_LT(found.digits_left, -std::log10(tolerance));
    EXPECT_NE(text_of(found).find("of the digits of the tolerance"), std::string::npos);
    EXPECT_EQ(text_of(found).find("leaves 0.0 digits"), std::string::npos);
  }
  // A loose one knows nothing, a tight one sees what is wrong by more.
  GradientSubject wrong = exaggerated(subject, 1.5);
  wrong.tolerance = 1e-2;
  EXPECT_NE(text_of(differentiate(wrong, {"final"}, all, /*check=*/true)).find("cannot tell"), std::string::npos);
  wrong.tolerance = 1e-9;
  EXPECT_GT(differentiate(wrong, {"final"}, all, /*check=*/true).contradicted.size(), 14u);
}

TEST(GradientChecks, NothingIsToldAgainstDerivativesThatAreRounding) {
  const GradientSubject subject =
      with_columns(subject_of(Valley()),
                   {{"E", "px^2/2 + py^2/2 - parameters.stiffness*cos(0.6*x+0.8*y) + (x^2+y^2)/2"}, {"zero", "E - E"}});
  const GradientTable found = differentiate(subject, {"final.zero"}, all, /*check=*/true);
  EXPECT_TRUE(found.within_rounding);
  EXPECT_EQ(found.contradicted, Names{});
  EXPECT_EQ(found.untold, Names{});
}

TEST(GradientChecks, GrowthDependsOnTheRunAndNotOnColumnsNorUnits) {
  const GradientSubject subject = subject_of(Valley(), 400);
  const double growth = differentiate(subject, {"final"}, all, false).growth;
  EXPECT_GT(growth, 1.5);
  for (const char* by : {"initial.x", "initial.py", "parameters.stiffness"})
    EXPECT_NEAR(differentiate(subject, {"final.x"}, {by}, false).growth / growth, 1, 1e-6) << by;
  // Momenta of the start in other units.
  GradientSubject other = subject;
  other.begun_by = [](const Names& parameters, const std::vector<Nudge>&) {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(4, 4 + Eigen::Index(parameters.size()));
    out.diagonal() << 1, 1, 1e6, 1e6;
    return out;
  };
  EXPECT_NEAR(differentiate(other, {"final"}, {"initial"}, false).growth / growth, 1, 1e-6);
}

TEST(GradientChecks, NumbersThatAreNoneEndTheTable) {
  const GradientSubject subject =
      with_columns(subject_of(Valley()), {{"none", "log(x-9)"}, {"steep", "sqrt(x-0.5)"}, {"sum", "x+y"}});
  const GradientTable sum = differentiate(subject, {"final.sum"}, all, false);
  EXPECT_EQ(sum.failure, "");
  EXPECT_TRUE(std::isfinite(sum.growth));
  EXPECT_NE(differentiate(subject, {"final.none"}, all, false).failure.find("final.none is no finite number"),
            std::string::npos);
  EXPECT_NE(differentiate(subject, {"node.0.steep"}, all, false).failure.find("node.0.steep has no finite derivative"),
            std::string::npos);
}

TEST(GradientChecks, NamesAndNumbersOfAnotherCountAreAFaultAndNotWrittenPast) {
  GradientSubject subject = subject_of(Valley());
  subject.observed.pop_back();
  EXPECT_THROW(differentiate(subject, {"final.x"}, {"initial"}, false), std::logic_error);
  const GradientSubject more = with_columns(subject, {{"w", "sin(x)"}});
  EXPECT_THROW(differentiate(more, {"final.w"}, {"initial"}, false), std::logic_error);
  ComputedNumber sum({"sum", "a+b"}, {"a", "b"});
  EXPECT_EQ(sum.evaluate({1, 2}), 3);
  EXPECT_THROW(sum.evaluate({1, 2, 3}), std::logic_error);
}

TEST(GradientChecks, DirectionsAreTheNumbersOfTheScene) {
  // The scene has (3, 4), the system (0.6, 0.8).
  const Eigen::Vector2d given(3, 4);
  const GradientSubject of_system = subject_of(Valley());
  const GradientSubject subject = in_numbers_of_the_scene(of_system, {{"across", given}});
  const Names by{"initial", "parameters.across.1", "parameters.stiffness"};
  const GradientTable found = differentiate(subject, {"final"}, by, /*check=*/true);
  EXPECT_EQ(found.contradicted, Names{});
  EXPECT_GT(found.digits_agreed, 8);
  // Those of runs that begin with such a scene.
  const auto end = [](const Eigen::Vector2d& across) {
    Valley valley;
    valley.across = across.normalized();
    return differentiate(subject_of(valley), {"final"}, {"initial"}, false).values;
  };
  const double width = 1e-4;
  const Eigen::VectorXd difference =
      (end(given + Eigen::Vector2d(0, width)) - end(given - Eigen::Vector2d(0, width))) / (2 * width);
  EXPECT_LT((found.derivatives.col(4) - difference).norm(), 1e-7 * difference.norm());
  const GradientTable plain = differentiate(of_system, {"final"}, by, false);
  EXPECT_GT((plain.derivatives.col(4) - difference).norm(), 0.5 * difference.norm());
  EXPECT_LT((plain.derivatives.col(5) - found.derivatives.col(5)).norm(), 1e-14 * plain.derivatives.norm());
  // Of one function it goes backward; the length does not count.
  const GradientTable backward = differentiate(subject, {"final.x"}, all, false);
  EXPECT_NEAR(backward.derivatives(0, 6), found.derivatives(0, 4), 1e-12);
  EXPECT_NEAR(backward.derivatives.row(0).segment(5, 2).dot(given), 0, 1e-12);
}

}  // namespace
}  // namespace lagroid::app::gradient_checks_tests
