// The suites of steps of any size hold for what is sound, and fail for what is broken.
#include <lagroid/core/testing/sampling.hpp>
#include <lagroid/run/formula/formula_lagrangian.hpp>
#include <lagroid/solvers/galerkin/curve_step.hpp>
#include <lagroid/solvers/galerkin/testing/sized_step_laws.hpp>

#include <gtest/gtest.h>

#include <memory>

using namespace lagroid;

namespace formulas_laws_tests {
namespace {

const FormulaLagrangian& orbit() {
  static const FormulaLagrangian read({.coordinates = {"x", "y"}}, "(x'^2 + y'^2)/2 + 1/sqrt(x^2 + y^2)");
  return read;
}

/// A step along curves that is taken wrong.
enum class Fault { none, gains, drags, order };
class Broken final : public SizedStep {
 public:
  Broken(const SizedLagrangian& l, Fault fault) : step_(l, {CurveQuadrature::gauss, 2}), fault_(fault) {}
  StepReport take(SizedState& z, double t, double h) override {
    const StepReport report = step_.take(z, t, h);
    Eigen::VectorXd& p = z.momentum;
    if (fault_ == Fault::gains) p *= 1 + 1e-3 * h * h;  // the same forwards and backwards
    if (fault_ == Fault::drags) p *= 1 - 1e-3 * h;
    if (fault_ == Fault::order) z.position(0) += 1e-2 * h * h * h * p(0);
    return report;
  }
  bool linearise(SizedState&, double, double, std::vector<SizedSlopes>&) override { return false; }
  void find_velocity(const SizedState& z, double t, TangentState& out) const override {
    step_.find_velocity(z, t, out);
  }

 private:
  CurveStep step_;
  Fault fault_;
};

laws::LawReport report_of(Fault fault) {
  laws::SizedStepSubject subject{.name = "orbit",
                                 .make = [=] { return std::make_unique<Broken>(orbit(), fault); },
                                 .traits = {"Gauss 2", 4, true, true, false},
                                 .start = {Eigen::Vector2d(1, 0), Eigen::Vector2d(0.1, 1.1)},
                                 .step = 0.1};
  subject.exact = [&](double later) {
    CurveStep precise(orbit(), {CurveQuadrature::gauss, 5});
    SizedState z = subject.start;
    Eigen::VectorXd both(4);
    for (int k = 0; k < 100; ++k) precise.take(z, 0, later / 100);
    both << z.position, z.momentum;
    return Eigen::VectorXd(both);
  };
  return laws::sized_step_laws(subject);
}

TEST(SizedStepLaws, HoldForAnOrbit) {
  const laws::LawReport report = report_of(Fault::none);
  EXPECT_EQ(report.laws.size(), 3u);
  EXPECT_TRUE(report.holds()) << report;
}
TEST(SizedStepLaws, FailForStepsThatAreBroken) {
  const laws::Sampling quiet(20, 1);
  EXPECT_FALSE(report_of(Fault::gains).law("the step is symplectic").holds());
  EXPECT_FALSE(report_of(Fault::gains).law("steps return to where they began").holds());
  EXPECT_FALSE(report_of(Fault::drags).law("the step is symplectic").holds());
  EXPECT_FALSE(report_of(Fault::drags).law("the error falls as declared").holds());
  EXPECT_FALSE(report_of(Fault::order).law("the error falls as declared").holds());
}

// Errors of eighth order leave round-off where steps are nearly too long to show it (examples/double_pendulum.toml):
// slopes do not agree there, and longer steps tell.
TEST(SizedStepLaws, HoldForADoublePendulumOfEighthOrder) {
  const FormulaLagrangian pendulum({.coordinates = {"a", "b"}},
                                   "0.8*a'^2 + 0.192*b'^2 + 0.48*a'*b'*cos(a-b) + 15.696*cos(a) + 4.7088*cos(b)");
  const auto along = [&](int points) {
    return std::make_unique<CurveStep>(pendulum, CurveChoice{CurveQuadrature::gauss, points});
  };
  laws::SizedStepSubject subject{.name = "double pendulum",
                                 .make = [=] { return along(4); },
                                 .traits = {"Gauss 4", 8, true, true, false},
                                 .start = {Eigen::Vector2d(0.9, -0.4), Eigen::Vector2d(0.06419971886990096, 0.192)},
                                 .step = 0.025};
  subject.exact = [&](double later) {
    const auto precise = along(5);
    SizedState z = subject.start;
    for (int k = 0; k < 400; ++k) precise->take(z, 0, later / 400);
    Eigen::VectorXd both(4);
    both << z.position, z.momentum;
    return both;
  };
  const laws::LawReport report = laws::sized_step_laws(subject);
  EXPECT_TRUE(report.holds()) << report;
  EXPECT_FALSE(report.law("the error falls as declared").unjudged) << report;
}

/// A Lagrangian whose second derivatives are symmetric and wrong: no step tells.
class WrongCurvature final : public SizedLagrangian {
 public:
  WrongCurvature() : SizedLagrangian({2, 0, false}) {}
  void lagrangian(double t, const double* q, const double* v, double* out) const override {
    orbit().lagrangian(t, q, v, out);
    out[5] *= 1.01;
  }
};
TEST(SizedLagrangianLaws, FailForDerivativesThatAreWrong) {
  const laws::Sampling quiet(20, 1);
  const WrongCurvature wrong;
  for (const SizedLagrangian* each :
       {static_cast<const SizedLagrangian*>(&orbit()), static_cast<const SizedLagrangian*>(&wrong)}) {
    const laws::SizedStepSubject subject{
        .name = "orbit",
        .make =
            [=] {
              return std::make_unique<CurveStep>(*each, CurveChoice{CurveQuadrature::gauss, 2});
            },
        .traits = {"Gauss 2", 4, true, true, false},
        .start = {Eigen::Vector2d(1, 0), Eigen::Vector2d(0.1, 1.1)},
        .step = 0.1};
    const laws::LawReport report = laws::sized_lagrangian_laws(*each, subject);
    EXPECT_EQ(report.law("derivatives are those of l").holds(), each == &orbit());
  }
}

}  // namespace
}  // namespace formulas_laws_tests
