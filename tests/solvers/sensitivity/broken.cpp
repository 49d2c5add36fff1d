// Subjects that break the laws of exact derivatives.

#include <lagroid/solvers/testing/sensitivity_laws.hpp>
#include <lagroid/systems/kepler.hpp>

#include "../../support/broken.hpp"

#include <gtest/gtest.h>

namespace lagroid::sensitivity_broken_tests {
namespace {

using laws::draw_uniform;

/// A spring whose derivatives along a run are those of a stiffer one: the Hessian is wrong, and symmetric all the same.
struct WrongHessian : MechanicalSystem<WrongHessian, 1> {
  double stiffness = 1;
  static auto parameters() {
    return std::tuple(parameter("stiffness", &WrongHessian::stiffness, "N/m", "of a spring"));
  }
  static double mass() { return 1; }
  template <class S> S potential(const Vector<S, 1>& q) const {
    const double wrong = std::is_same_v<ParameterScalar<S>, double> ? 1 : 1.1;
    return q(0) * q(0) * (varied<S>(stiffness) * (0.5 * wrong));
  }
};
TEST(SensitivityLaws, DifferencesSeeAWrongHessianThatIsSymplectic) {
  WrongHessian spring;
  spring.h = 0.1;
  const auto draw = [] {
    return State<Pair<1>>{Vector<double, 1>(2 + draw_uniform()), Vector<double, 1>(draw_uniform())};
  };
  // Of its state; the parameter's derivative would be refused.
  const State<Pair<1>> start = {Vector<double, 1>(2.0), Vector<double, 1>(0.0)};
  EXPECT_LE(laws::symplectic_defect(spring, start, 5), 1e-13);
  const auto found = sensitivities(spring, start, {.steps = 5});
  EXPECT_GT(laws::detail::relative_defect(found.by_start, laws::detail::differenced(spring, start, 5).leftCols(2)),
            1e-3);
  EXPECT_FALSE(laws::sensitivity_laws(spring, draw).holds());
}

/// Derivatives of a motion that is pulled to rest.
struct Damped : laws::RunDerivatives {
  template <class Sys>
  auto forward(const Sys& system, const State<typename Sys::GroupoidType>& start,
               const SensitivityOptions<Sys>& options) const {
    auto found = laws::RunDerivatives::forward(system, start, options);
    found.by_start *= 0.99;
    return found;
  }
};
TEST(BrokenSensitivity, FailsTheLawsOfDerivatives) {
  Kepler kepler;
  kepler.h = 0.05;
  const auto draw = [] {
    return State<Pair<2>>{{1 + 0.1 * draw_uniform(), 0.1 * draw_uniform()}, {0.1 * draw_uniform(), 1.1}};
  };
  const auto report = laws::sensitivity_laws(kepler, draw, 5, Damped());
  EXPECT_TRUE(laws::seen_broken(report.law("the transition matrix is symplectic"))) << report;
  EXPECT_TRUE(laws::seen_broken(report.law("backward is forward"))) << report;
  EXPECT_TRUE(laws::seen_broken(report.law("differences of the program"))) << report;
}

/// A motion that does not go back to the state that it is restored to: what is taken backwards is wrong.
class Forgetful final : public LinearisedMotion {
 public:
  explicit Forgetful(LinearisedMotion& motion) : motion_(motion) {}
  int states() const override { return motion_.states(); }
  int parameters() const override { return motion_.parameters(); }
  double time() const override { return motion_.time(); }
  StepReport advance() override { return motion_.advance(); }
  bool linearise() override { return motion_.linearise(); }
  int stages() const override { return motion_.stages(); }
  const StepDerivative& stage(int k) const override { return motion_.stage(k); }
  NodeValues observe() const override { return motion_.observe(); }
  void serialize(NumberArchive& archive) override {
    if (!archive.reading()) motion_.serialize(archive);
  }

 private:
  LinearisedMotion& motion_;
};
TEST(SensitivityLaws, BackwardNeedsTheStatesOfTheMotion) {
  Kepler kepler;
  kepler.h = 0.05;
  const State<Pair<2>> start{{1, 0}, {0, 1.1}};
  const auto motion = [&] {
    return std::make_unique<LinearisedMotionOf<Kepler>>(
        kepler, detail::newton_integrator<Kepler>(kepler, start, {}), std::vector<std::string>{"strength"},
        [](const ObservedNode<Kepler>& node) { return VariedVector(node.momentum); });
  };
  const auto forward = propagate_forward(*motion(), 20, Eigen::MatrixXd::Identity(5, 5));
  for (const long states : {1L, 2L, 3L, 5L, 20L, 100L}) {
    const auto backward = propagate_backward(*motion(), 20, Observed::at_end(), {states});
    EXPECT_LE(laws::detail::relative_defect(backward.derivatives, forward.derivatives), 1e-13) << states;
    EXPECT_LE(backward.states_kept, states);
  }
  const auto honest = motion();
  Forgetful forgetful(*honest);
  const auto wrong = propagate_backward(forgetful, 20);
  EXPECT_GT(laws::detail::relative_defect(wrong.derivatives, forward.derivatives), 1e-3);
}

/// A motion that has no derivatives.
class Rough final : public LinearisedMotion {
 public:
  explicit Rough(LinearisedMotion& motion) : motion_(motion) {}
  int states() const override { return motion_.states(); }
  int parameters() const override { return motion_.parameters(); }
  double time() const override { return motion_.time(); }
  StepReport advance() override { return motion_.advance(); }
  bool linearise() override { return false; }
  int stages() const override { return motion_.stages(); }
  const StepDerivative& stage(int k) const override { return motion_.stage(k); }
  NodeValues observe() const override { return motion_.observe(); }
  void serialize(NumberArchive& archive) override { motion_.serialize(archive); }

 private:
  LinearisedMotion& motion_;
};
// What differences are made of costs no derivatives.
TEST(SensitivityLaws, ValuesAloneNeedNoDerivatives) {
  Kepler kepler;
  kepler.h = 0.05;
  const State<Pair<2>> start{{1, 0}, {0, 1.1}};
  const auto run = [&](Eigen::Index directions, bool is_rough) {
    LinearisedMotionOf<Kepler> motion(kepler, detail::newton_integrator<Kepler>(kepler, start, {}), {"strength"},
                                      [](const ObservedNode<Kepler>& node) { return VariedVector(node.momentum); });
    Rough rough(motion);
    return propagate_forward(is_rough ? static_cast<LinearisedMotion&>(rough) : motion, 20,
                             Eigen::MatrixXd::Identity(5, directions), Observed::integral());
  };
  const Propagated smooth = run(5, false), values = run(0, true);
  EXPECT_EQ(run(5, true).status, SolveStatus::singular);
  ASSERT_TRUE(values.converged());
  EXPECT_EQ(values.values, smooth.values);
  EXPECT_EQ(values.derivatives.cols(), 0);
  EXPECT_EQ(values.steps_solved, smooth.steps_solved);
}

}  // namespace
}  // namespace lagroid::sensitivity_broken_tests
