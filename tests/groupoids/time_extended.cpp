// Mechanics on R x R x G ([G] 6.3): free time, prescribed steps, explicit dependence on time.
#include <lagroid/core/capabilities/discrete_energy.hpp>
#include <lagroid/groupoids/time_extended.hpp>
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/solvers/testing/dynamics_laws.hpp>
#include <lagroid/systems/control/attitude_control.hpp>
#include <lagroid/systems/pendulums/driven_pendulum.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/draws.hpp"

using namespace lagroid;

namespace groupoids_time_extended_tests {
namespace {

template <class Sys> FixedStepIntegrator<Sys> make(const Sys& system, const State<typename Sys::GroupoidType>& start) {
  return {system, start, system.groupoid.unit(start.object), std::make_unique<NewtonStep<Sys>>()};
}

/// (t, q) with momentum (p_t, mu).
template <class Sys>
State<TimeExtended<typename Sys::GroupoidType>> extended(double time, double time_momentum,
                                                         const State<typename Sys::GroupoidType>& s) {
  State<TimeExtended<typename Sys::GroupoidType>> out;
  out.object = {Vector<double, 1>(time), s.object};
  out.momentum << time_momentum, s.momentum;
  return out;
}

template <class Sys> class Decoupling : public ::testing::Test {
 public:
  static constexpr double h = 0.1;
  Sys system;
  State<typename Sys::GroupoidType> start;

  void SetUp() override {
    system.h = h;
    if constexpr (std::is_same_v<Sys, AttitudeControl>) {
      system.weights << 1, 2, 3;
      start.momentum << 0.3, 0.8, -0.2;
    } else {
      start = {Vector<double, 1>(1.2), Vector<double, 1>(0.3)};
    }
    if constexpr (std::is_same_v<Sys, DrivenPendulum>) {
      system.torque = 0.4;
      system.amplitude = 0.1;
      system.frequency = 2.3;
      system.time = 0.7;
    }
  }
};
using Systems = ::testing::Types<Pendulum, DrivenPendulum, AttitudeControl>;
TYPED_TEST_SUITE(Decoupling, Systems);

// [G] Example 6.2: the equations on G are those of the untimed system; p_t is what the multiplier and E_d leave, and
// changes by what time itself does to L.
TYPED_TEST(Decoupling, FixedStepsAreThoseOfTheUntimedSystem) {
  const FixedStep<TypeParam> timed(this->system, ConstantStep{this->h});
  const double t0 = start_time(this->system);
  auto with_time = make(timed, extended<TypeParam>(t0, 0.37, this->start));
  auto without = make(this->system, this->start);
  double driven = 0;
  for (int k = 0; k < 50; ++k) {
    const double before = with_time.point().state.momentum(0);
    ASSERT_TRUE(with_time.advance().converged()) << k;
    ASSERT_TRUE(without.advance().converged()) << k;
    const auto& a = with_time.point();
    const auto& b = without.point();
    EXPECT_NEAR((a.state.momentum.template tail<TypeParam::dimension>() - b.state.momentum).norm(), 0, 1e-13);
    EXPECT_NEAR((std::get<1>(a.state.object) - b.state.object).norm(), 0, 1e-13);
    EXPECT_NEAR(std::get<0>(a.state.object)(0), b.time, 1e-13);
    // F+_t = dL/dh + lambda, and F+_t - F-_t is the derivative of L by the time at which the arrow starts.
    using D = Dual<double>;
    const double change = lagrangian_over(this->system, this->system.groupoid.template cast<D>(b.step.arrow),
                                          D(b.time - this->h, 1.0), D(this->h))
                              .derivative;
    driven = std::max(driven, std::abs(change));
    const double energy = discrete_energy(this->system, b.step, b.time - this->h, this->h);
    const double lambda = a.step.multipliers(TypeParam::constraints);
    EXPECT_NEAR(lambda - energy, a.state.momentum(0), 1e-11);
    EXPECT_NEAR(a.state.momentum(0) - before, change, 1e-12);
  }
  EXPECT_EQ(driven > 1e-3, TimeDependent<TypeParam>);
  EXPECT_EQ(driven != 0, TimeDependent<TypeParam>);
}

// The momentum of free time is minus the discrete energy, the multiplier's term included.
TEST(FreeTime, MomentumOfTimeIsMinusTheDiscreteEnergy) {
  AttitudeControl system;
  system.weights << 1, 2, 3;
  system.h = 0.2;
  auto run = make(system, {{}, {0.3, 0.8, -0.2}});
  ASSERT_TRUE(run.advance().converged());
  const auto& step = run.point().step;
  const FreeTime<AttitudeControl> free(system);
  Step<FreeTime<AttitudeControl>> timed;
  timed.arrow = {PairArrow<double, 1>{Vector<double, 1>(0.0), Vector<double, 1>(0.2)}, step.arrow};
  timed.multipliers = step.multipliers;
  const double energy = discrete_energy(system, step, 0, 0.2);
  EXPECT_NEAR(legendre_minus(free, timed).momentum(0), -energy, 1e-14);
  EXPECT_NEAR(legendre_plus(free, timed).momentum(0), -energy, 1e-14);
}

// h(g), symmetric in g: the time scale of a swing at the middle of the arrow.
struct AtTheMiddle {
  double epsilon = 0.1;
  template <class Base, class S> S operator()(const Base&, const PairArrow<S, 1>& g) const {
    using std::cos;
    return epsilon * (1.5 + cos((g.source(0) + g.target(0)) * 0.5));
  }
};
// The same at the source: not symmetric.
struct AtTheSource {
  double epsilon = 0.1;
  template <class Base, class S> S operator()(const Base&, const PairArrow<S, 1>& g) const {
    using std::cos;
    return epsilon * (1.5 + cos(g.source(0)));
  }
};

// A state whose p_t makes the multiplier of the step small: p_t = -E.
template <class StepSize> State<TimeExtended<Pair<1>>> swing(const PrescribedStep<Pendulum, StepSize>& timed) {
  const State<Pair<1>> s{Vector<double, 1>(laws::draw_uniform()), Vector<double, 1>(laws::draw_uniform())};
  return extended<Pendulum>(laws::draw_uniform(), -timed.base.energy(s), s);
}

TEST(PrescribedStep, IsSymplecticAndReversibleWithAStepSizeFunction) {
  const PrescribedStep<Pendulum, AtTheMiddle> timed(Pendulum{}, AtTheMiddle{});
  const auto report = laws::dynamics_laws(timed, [&] { return swing(timed); });
  EXPECT_TRUE(report.holds()) << report;
}

// The step sizes are those of the function, and back again from the end with the momentum turned round.
template <class StepSize> double return_error() {
  const PrescribedStep<Pendulum, StepSize> timed(Pendulum{}, StepSize{});
  const State<Pair<1>> s{Vector<double, 1>(0.4), Vector<double, 1>(0.9)};
  auto out = make(timed, extended<Pendulum>(0, -timed.base.energy(s), s));
  for (int k = 0; k < 40; ++k) EXPECT_TRUE(out.advance().converged()) << k;
  auto turned = out.point().state;
  turned.momentum(1) *= -1;
  auto back = make(timed, turned);
  for (int k = 0; k < 40; ++k) EXPECT_TRUE(back.advance().converged()) << k;
  return std::abs(std::get<1>(back.point().state.object)(0) - 0.4) + std::abs(back.point().state.momentum(1) + 0.9);
}
TEST(PrescribedStep, ReturnsWhenTheStepSizeIsSymmetric) {
  EXPECT_LT(return_error<AtTheMiddle>(), 1e-11);
  EXPECT_GT(return_error<AtTheSource>(), 1e-4) << "the step size at the source is not symmetric";
}

// Explicit time and a step size function together.
TEST(PrescribedStep, OfADrivenMotionIsOfOrderTwo) {
  DrivenPendulum system;
  system.torque = 0.4;
  system.amplitude = 0.1;
  system.frequency = 2.3;
  const State<Pair<1>> start{Vector<double, 1>(1.2), Vector<double, 1>(0.3)};
  std::vector<double> errors;
  for (const double epsilon : {0.02, 0.01, 0.005}) {
    const PrescribedStep<DrivenPendulum, AtTheMiddle> timed(system, AtTheMiddle{epsilon});
    auto run = make(timed, extended<DrivenPendulum>(0, -system.energy(start, 0), start));
    const auto time = [&] { return std::get<0>(run.point().state.object)(0); };
    while (time() < 5) ASSERT_TRUE(run.advance().converged()) << time();
    const auto exact = system.reference(start, time());
    errors.push_back(std::abs(std::get<1>(run.point().state.object)(0) - exact.object(0)) +
                     std::abs(run.point().state.momentum(1) - exact.momentum(0)));
  }
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2, 0.1);
  EXPECT_NEAR(std::log2(errors[1] / errors[2]), 2, 0.1);
}

TEST(DrivenPendulum, FollowsTheReferenceToOrderTwo) {
  DrivenPendulum system;
  system.torque = 0.4;
  system.amplitude = 0.1;
  system.frequency = 2.3;
  system.time = 0.7;
  const State<Pair<1>> start{Vector<double, 1>(1.2), Vector<double, 1>(0.3)};
  const auto exact = system.reference(start, 5);
  std::vector<double> errors;
  for (const int steps : {200, 400, 800}) {
    system.h = 5.0 / steps;
    auto run = make(system, start);
    for (int k = 0; k < steps; ++k) ASSERT_TRUE(run.advance().converged());
    EXPECT_NEAR(run.point().time, 5.7, 1e-13);
    errors.push_back((run.point().state.object - exact.object).norm() +
                     (run.point().state.momentum - exact.momentum).norm());
  }
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2, 0.05);
  EXPECT_NEAR(std::log2(errors[1] / errors[2]), 2, 0.05);
}

// Kapitza: fast shaking holds the pendulum upright; slow shaking does not.
TEST(DrivenPendulum, StandsUprightOnAFastSupport) {
  const auto farthest = [](double frequency) {
    DrivenPendulum system;
    system.amplitude = 0.1;
    system.frequency = frequency;
    system.h = 0.05 / frequency;
    auto run = make(system, {Vector<double, 1>(M_PI - 0.05), Vector<double, 1>(0.0)});
    double angle = 0;
    while (run.point().time < 40) {
      if (!run.advance().converged()) {
        ADD_FAILURE() << run.point().time;
        break;
      }
      angle = std::max(angle, std::abs(run.point().state.object(0) - M_PI));
    }
    return angle;
  };
  EXPECT_LT(farthest(30), 0.1);
  EXPECT_GT(farthest(8), 1);
}

}  // namespace
}  // namespace groupoids_time_extended_tests
